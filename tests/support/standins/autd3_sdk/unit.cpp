#include "unit.hpp"

#include <algorithm>

namespace standin {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;  // [ns]

std::uint64_t number(const Bytes& in, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value |= static_cast<std::uint64_t>(in[at + i]) << (8 * i);
  return value;
}

void put(Bytes& out, std::uint64_t value, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

Bytes from(const Bytes& in, std::size_t at) {
  return {in.begin() + static_cast<std::ptrdiff_t>(at), in.end()};
}

}  // namespace

void Findings::error(const std::string& what) {
  ++protocol_errors;
  last_error = what;
}

void Unit::set_clock(std::int64_t now, std::int64_t time, bool locks) {
  sounded_ = last_sounding();
  playback.last_sounding = -1;
  offset_ = time - now;
  playback.jump(time);
  locked_at_ = locks ? now + (grandmaster_ ? 0 : behaviour_.lock_time) : -1;
  ready_at_ = locks ? now + behaviour_.ready_time : -1;
}

std::int64_t Unit::last_sounding() const {
  return playback.last_sounding < 0 ? sounded_ : playback.last_sounding - offset_;
}

void Unit::forget() {
  id_ = -1;
  grandmaster_ = open = false;
  forgets_at_ = locked_at_ = ready_at_ = -1;
}

void Unit::clear() {
  playback.clear();
  playback.muted = false;
  silent_ = strict_ = false;
  steps_intensity_ = 10;
  steps_phase_ = 40;
  failsafe_ = 500;
}

void Unit::power_cycle() {
  forget();
  clear();
  synchronised_ = false;
  host_at_ = -1;
  expected_ = error_ = 0;
  ack_ = last_sequence_ = last_command_ = 0xFF;
}

void Unit::trip() {
  playback.muted = true;
  ++trips;
}

void Unit::advance(std::int64_t now) {
  now = std::max(now, now_);
  if (forgets_at_ >= 0 && now >= forgets_at_) forget();
  const std::int64_t due = host_at_ + failsafe_ * kMillisecond;
  if (host_at_ >= 0 && failsafe_ > 0 && now >= due && !silent_) {
    playback.advance(time(std::max(due, now_)));
    silent_ = true;
    trip();
  }
  playback.advance(time(now));
  now_ = now;
}

Bytes Unit::status(const Bytes& in, int code, const Bytes& body) const {
  Bytes out(in.begin(), in.begin() + 4);
  out[0] = 2;
  const auto other = behaviour_.statuses.find(in[1]);
  out.push_back(
      static_cast<std::uint8_t>(other == behaviour_.statuses.end() ? code : other->second));
  out.insert(out.end(), body.begin(), body.end());
  return out;
}

std::uint8_t Unit::flags(std::int64_t now, bool last) const {
  const bool locked = locked_at_ >= 0 && now >= locked_at_ && !behaviour_.unlocked;
  const bool ready = ready_at_ >= 0 && now >= ready_at_ && !behaviour_.never_ready;
  return static_cast<std::uint8_t>((id_ >= 0 ? 1 : 0) | (open ? 2 : 0) | (last ? 0 : 4) |
                                   (ready ? 8 : 0) | (locked ? 16 : 0) | (grandmaster_ ? 32 : 0));
}

Bytes Unit::info(std::int64_t now, const Bytes& in, bool last) const {
  Bytes body;
  put(body, id_ >= 0 ? static_cast<std::uint64_t>(id_) : 0xFF, 1);
  put(body, flags(now, last), 1);
  put(body, id_ >= 0 ? 0 : 0xFF, 1);
  put(body, 0, 1);
  for (const unsigned part : {0U, 10U, 0U, 0U}) put(body, part, 1);
  put(body, static_cast<std::uint64_t>(time(now)), 8);
  put(body, 0, 4);
  return status(in, 0, body);
}

Bytes Unit::frame_reply(std::int64_t now, const Bytes& in, bool last) const {
  Bytes out(in.begin(), in.begin() + 4);
  put(out, static_cast<std::uint64_t>(ack_), 1);
  put(out, static_cast<std::uint64_t>(error_), 1);
  put(out, flags(now, last), 1);
  put(out, static_cast<std::uint64_t>(id_), 1);
  put(out, static_cast<std::uint64_t>(time(now)), 8);
  out.insert(out.end(), data_.begin(), data_.end());
  return out;
}

std::optional<Bytes> Unit::answer(std::int64_t now, const Bytes& in, bool unicast, bool last) {
  enum { Frame, ReadInfo, ResetId, Discover, AssignId, Unblock, SetTime, Heartbeat };
  sets_time = false;
  advance(now);
  if (in.size() < 4 || in[1] > Heartbeat) {
    findings_.error("a datagram of " + std::to_string(in.size()) + " bytes or of unknown kind");
    return std::nullopt;
  }
  if (in[0] != 2) {
    findings_.error("a datagram of version " + std::to_string(in[0]));
    return status(in, 1);
  }
  const int kind = in[1];
  const bool alone =
      kind == Frame || kind == AssignId || kind == Unblock || kind == SetTime || kind == Heartbeat;
  if (alone && !unicast) {
    findings_.error("kind " + std::to_string(kind) + " to the group");
    return std::nullopt;
  }
  const std::size_t least = kind == Frame ? 6 : kind == AssignId ? 6 : kind == SetTime ? 12 : 4;
  if (in.size() < least || (kind != Frame && in.size() != least) || in.size() > 1452) {
    findings_.error("kind " + std::to_string(kind) + " of " + std::to_string(in.size()) + " bytes");
    return kind == Frame || kind == Heartbeat ? std::nullopt : std::optional(status(in, 3));
  }
  switch (kind) {
    case ReadInfo:
      return info(now, in, last);
    case ResetId:
      if (forgets_at_ < 0) forgets_at_ = now + 20 * kMillisecond;
      return status(in, 0);
    case Discover:
      return id_ < 0 ? std::optional(status(in, 0)) : std::nullopt;
    case AssignId:
      return id_ < 0 ? std::optional(assign(in)) : std::nullopt;
    case Unblock:
      if (id_ < 0) return status(in, 2);
      open = true;
      return status(in, 0, {static_cast<std::uint8_t>(last ? 0 : 1)});
    case SetTime:
      return set_time(in);
    default:
      break;
  }
  if (id_ < 0) return std::nullopt;
  host_at_ = now_;
  silent_ = false;
  if (kind == Heartbeat) {
    ++findings_.heartbeats;
    return frame_reply(now, in, last);
  }
  frame(now, in);
  return frame_reply(now, in, last);
}

Bytes Unit::assign(const Bytes& in) {
  if (in[4] == 0xFF || in[5] > 1 || (in[4] == 0) != (in[5] == 1)) {
    findings_.error("number " + std::to_string(in[4]) + " with role " + std::to_string(in[5]));
    return status(in, 3);
  }
  id_ = in[4];
  grandmaster_ = in[5] == 1;
  forgets_at_ = -1;
  return status(in, 0);
}

Bytes Unit::set_time(const Bytes& in) {
  if (id_ < 0) return status(in, 2);
  if (!grandmaster_) return status(in, 4);
  sets_time = true;
  set_to = static_cast<std::int64_t>(number(in, 4, 8));
  return status(in, 0);
}

/// Executes a frame that arrives in sequence.
void Unit::frame(std::int64_t now, const Bytes& in) {
  const int sequence = in[4], command = in[5];
  ++findings_.frames;
  if (sequence == last_sequence_ && command == last_command_) {
    ++findings_.duplicates;
    return;
  }
  last_sequence_ = sequence;
  last_command_ = command;
  if (command == 0) {
    ++findings_.resets;
    expected_ = error_ = 0;
    ack_ = 0xFF;
    data_.clear();
    return;
  }
  if (sequence != expected_) {
    ++findings_.mismatches;
    return;
  }
  now_ = std::max(now_, now);
  expected_ = (expected_ + 1) % 256;
  data_.clear();
  error_ = execute(command, from(in, 6));
  ack_ = sequence;
}

int Unit::execute(int command, const Bytes& p) {
  const auto refused = behaviour_.refusals.find(command);
  if (refused != behaviour_.refusals.end() && refused->second.second != 0) {
    --refused->second.second;
    return refused->second.first;
  }
  const bool bare = command < 0x05 || command == 0x06 || command > 0xE0;
  if (bare && !p.empty()) {
    findings_.error("command " + std::to_string(command) + " with a payload");
    return 2;
  }
  const int error = dispatch(command, p);
  if (error == 2 && !(command == 0x12 && (p.size() == 10 || p.size() == 14)))
    findings_.error("command " + std::to_string(command) + " with a payload that cannot be");
  return error;
}

int Unit::dispatch(int command, const Bytes& p) {
  switch (command) {
    case 0x01:
      if (ready_at_ < 0 || now_ < ready_at_) return 8;
      synchronised_ = true;
      return 0;
    case 0x03:
      if (behaviour_.forgets_to_release) return 0x15;
      ++findings_.clears;
      clear();
      return 0;
    case 0x04:
      return 0;
    case 0x05:
      return cpu_config(p);
    case 0x06:
      return release();
    case 0x10:
      return write_foci(p);
    case 0x11:
      return config_pattern(p);
    case 0x12:
      return activate(p);
    case 0x30:
      return silencer(p);
    case 0xE7:
      data_ = {static_cast<std::uint8_t>(
          (hot ? 1 : 0) | (playback.bank() == 1 ? 4 : 0) | (playback.stopped() ? 16 : 0) |
          (playback.pending() ? 64 : 0) | (playback.muted ? 128 : 0))};
      return 0;
    case 0xEB:
      data_ = {0, 10, 0, 0, 10, 0, 0, 0};
      return 0;
    default:
      findings_.error("unknown command " + std::to_string(command));
      return 1;
  }
}

int Unit::write_foci(const Bytes& p) {
  if (p.size() < 8 || p[0] > 1 || p[1] != 0) return 2;
  const std::uint64_t first = number(p, 2, 4), bytes = number(p, 6, 2);
  if (bytes + 8 != p.size() || bytes == 0 || bytes > 1438 || bytes % 8 != 0 || first % 4 != 0)
    return 2;
  if (first + bytes / 2 > 262'144) return 2;
  const bool pending = playback.pending() && playback.pending_bank() == p[0];
  const bool plays = playback.bank() == p[0] && !playback.banks[p[0]].raw;
  for (std::uint64_t i = 0; i < bytes / 8; ++i) {
    std::uint64_t& word = playback.banks[p[0]].words[first / 4 + i];
    const std::uint64_t next = number(p, 8 + 8 * i, 8);
    // an executed frame may arrive again if its acknowledgement was lost
    if (word != next && (plays || pending)) findings_.error("a bank is written while it plays");
    word = next;
  }
  return 0;
}

int Unit::config_pattern(const Bytes& p) {
  if (p.size() != 14 || p[0] > 1 || p[1] != 0 || p[9] != 0) return 2;
  const auto divider = static_cast<std::uint32_t>(number(p, 2, 2)),
             samples = static_cast<std::uint32_t>(number(p, 4, 4)),
             sound = static_cast<std::uint32_t>(number(p, 10, 2));
  const std::uint32_t slots = p[8];
  if (divider == 0 || samples < 2 || slots < 1 || slots > 8 || samples > 65536 / slots) return 2;
  // 310 to 370 m/s
  if (sound < 310 * 64 || sound > 370 * 64) return 2;
  if (strict_ && (divider < steps_intensity_ || divider < steps_phase_)) return 4;
  if (playback.bank() == p[0] && !playback.banks[p[0]].raw)
    findings_.error("a bank is configured while it plays");
  Bank& bank = playback.banks[p[0]];
  bank.raw = false;
  bank.divider = divider;
  bank.samples = samples;
  bank.slots = slots;
  bank.repetitions = static_cast<std::uint32_t>(number(p, 12, 2));
  return 0;
}

int Unit::activate(const Bytes& p) {
  if (p.size() != behaviour_.activate_bytes || p[0] > 1) return 2;
  const int mode = p[1];
  const Bank& bank = playback.banks[p[0]];
  if (mode != 0 && mode != 1 && mode != 2 && mode != 0xF0 && mode != 0xFF) return 2;
  const bool endless = bank.repetitions == 0xFFFF, timed = mode <= 2;
  if (endless == timed) return 5;
  if (strict_ && (bank.divider < steps_intensity_ || bank.divider < steps_phase_)) return 4;
  if (mode == 1 || mode == 2) {
    findings_.error("a change of banks that this unit does not simulate");
    return 6;
  }
  if (!synchronised_) findings_.error("a change of banks before Synchronize");
  if (bank.raw) findings_.error("a change to a bank without a pattern");
  playback.activate(p[0], mode);
  return 0;
}

int Unit::silencer(const Bytes& p) {
  if (p.size() != 10 || p[0] > 3 || p[1] != 0) return 2;
  const bool rate = (p[0] & 1) != 0;
  const std::size_t at = rate ? 2 : 6;
  if (number(p, at, 2) == 0 || number(p, at + 2, 2) == 0) return 2;
  if (rate) return strict_ = false, 0;
  const auto intensity = static_cast<std::uint32_t>(number(p, 6, 2)),
             phase = static_cast<std::uint32_t>(number(p, 8, 2));
  const std::uint32_t divider = playback.banks[static_cast<std::size_t>(playback.bank())].divider;
  const bool strict = (p[0] & 2) != 0;
  if (strict && (divider < intensity || divider < phase)) return 4;
  strict_ = strict;
  steps_intensity_ = intensity;
  steps_phase_ = phase;
  return 0;
}

int Unit::cpu_config(const Bytes& p) {
  struct Field {
    std::size_t at, size;
    std::uint64_t value;
  };
  constexpr std::array kFields = {
      Field{0, 4, 10'000'000}, Field{4, 4, 1'000'000}, Field{8, 4, 2'000'000'000},
      Field{12, 4, 250'000},   Field{16, 2, 100},      Field{18, 2, 8},
      Field{20, 2, 3},         Field{22, 2, 6},        Field{24, 2, 1000},
      Field{26, 2, 64},        Field{28, 4, 10'000},   Field{32, 4, 100},
      Field{36, 4, 50},        Field{40, 4, 1},        Field{44, 4, 500'000},
      Field{50, 2, 32},        Field{52, 2, 5},        Field{54, 2, 48},
      Field{56, 2, 64},        Field{58, 2, 8},        Field{60, 2, 0},
      Field{62, 2, 3}};
  if (p.size() != 64) return 2;
  for (const Field& field : kFields)
    if (number(p, field.at, field.size) != field.value)
      findings_.error("the processor's setting at " + std::to_string(field.at) + " is no default");
  failsafe_ = static_cast<std::int64_t>(number(p, 48, 2));
  return 0;
}

int Unit::release() {
  ++findings_.releases;
  if (behaviour_.forgets_to_release) return 0x15;
  playback.muted = false;
  return 0;
}

}  // namespace standin
