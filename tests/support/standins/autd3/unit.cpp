#include "unit.hpp"

#include <algorithm>

namespace standin {
namespace {

enum Error {
  kNoError = 0,
  kUnknownTag = 1,
  kBadMessage = 2,
  kBadInfo = 3,
  kBadSegmentChange = 5,
  kMissedTime = 6,
  kBadSilencer = 7,
  kBadMode = 8
};
constexpr int kBegin = 1, kEnd = 2, kUpdate = 4, kSegment1 = 8;
constexpr std::uint64_t kMargin = 10'000'000;  // by which a system time lies ahead [ns]
constexpr std::size_t kStoredFoci = 65'536, kStoredModulation = 65'536;
constexpr Shape kCleared{1, 0xFFFF, kEndless};

std::size_t at(int index) {
  return static_cast<std::size_t>(index);
}

}  // namespace

/// Reads a payload from its start. Reading beyond its end gives 0 and is recorded.
class Unit::Bytes {
 public:
  explicit Bytes(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  std::uint64_t number(int count) {
    std::uint64_t value = 0;
    for (int i = 0; i < count; ++i) {
      overrun_ = overrun_ || at_ >= bytes_.size();
      const std::uint64_t byte = at_ < bytes_.size() ? bytes_[at_] : 0;
      value |= byte << (8 * i);
      ++at_;
    }
    return value;
  }
  int u8() { return static_cast<int>(number(1)); }
  int u16() { return static_cast<int>(number(2)); }
  std::size_t left() const { return bytes_.size() - std::min(at_, bytes_.size()); }
  bool overrun() const { return overrun_; }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool overrun_ = false;
};

Unit::Unit() : foci_chain_(kCleared), modulation_chain_(kCleared) {
  clear();
}

void Unit::problem(const std::string& what) {
  ++problems_;
  if (first_problem_.empty()) first_problem_ = what;
}

void Unit::go_to(std::int64_t tick, std::uint64_t now) {
  tick_ = tick;
  now_ = now;
  foci_chain_.go_to(tick, gpio_, now);
  modulation_chain_.go_to(tick, gpio_, now);
  if (told_version_) return;
  if (reads_state_) {
    data_ = 0x80 | (hot_ ? 1 : 0) | (modulation_chain_.segment() == 1 ? 2 : 0) |
            (foci_chain_.segment() == 1 ? 4 : 0) | (foci_chain_.shape().cycle == 1 ? 8 : 0);
  } else {
    data_ &= 0x7F;
  }
}

std::array<std::uint8_t, 2> Unit::answer() const {
  return {static_cast<std::uint8_t>(data_),
          static_cast<std::uint8_t>(error_ << 4 | (last_id_ & 0xF))};
}

void Unit::take(std::span<const std::uint8_t> frame, std::int64_t tick, std::uint64_t now) {
  go_to(tick, now);
  const int id = frame[0];
  if (id == last_id_) return problem("a message id came twice: the frame is ignored");
  last_id_ = id;
  const int second = frame[2] | frame[3] << 8;
  must(frame[1] == 0, "byte 1 of a frame is not 0");
  if (id > 15) {
    error_ = kBadMessage;
  } else if (refusals_ > 0) {
    --refusals_;
    error_ = refusal_;
  } else {
    const std::span<const std::uint8_t> payload = frame.subspan(4);
    error_ = handle(payload);
    if (error_ == kNoError && second != 0) {
      must(second < kPayloadBytes && second % 2 == 0, "the second command lies outside the frame");
      if (second < kPayloadBytes) error_ = handle(payload.subspan(at(second)));
    }
  }
  ++errors_[at(error_)];
}

int Unit::handle(std::span<const std::uint8_t> payload) {
  Bytes in(payload);
  const int tag = in.u8();
  ++commands_[at(tag)];
  int error = kUnknownTag;
  switch (tag) {
    case 0x00:
      error = kNoError;
      break;
    case 0x01:
      error = clear();
      break;
    case 0x02:
      error = kNoError;
      break;
    case 0x03:
      error = firmware(in);
      break;
    case 0x10:
      error = modulation(in);
      break;
    case 0x21:
      error = silencer(in);
      break;
    case 0x30:
      error = gain(in);
      break;
    case 0x42:
      error = foci(in);
      break;
    case 0x44:
      error = swap_foci(in);
      break;
    case 0x61: {
      const int value = in.u8();
      must(value <= 1, "read-state is neither 0 nor 1");
      reads_state_ = value != 0;
      error = kNoError;
      break;
    }
    case 0xF1:
      gpio_ = in.u8();
      must(gpio_ < 16, "there are four GPIO inputs");
      error = kNoError;
      break;
    default:
      break;
  }
  must(!in.overrun(), "a command is longer than its frame");
  return error;
}

int Unit::clear() {
  reads_state_ = false;
  gpio_ = 0;
  strict_ = true;
  least_intensity_ = 10;
  least_phase_ = 40;
  foci_ = {};
  for (Segment& segment : foci_) segment.shape = kCleared;
  // both modulations are at full level
  for (Modulation& m : modulation_) m = {{255, 255}, {2, 0xFFFF, kEndless}};
  foci_segment_ = modulation_segment_ = 0;
  writes_foci_ = writes_modulation_ = -1;
  foci_chain_.set(0, foci_[0].shape, kSyncIdx, 0, tick_);
  modulation_chain_.set(0, modulation_[0].shape, kSyncIdx, 0, tick_);
  return kNoError;
}

int Unit::firmware(Bytes& in) {
  switch (in.u8()) {
    case 1:
      reads_state_before_ = reads_state_;
      reads_state_ = false;
      told_version_ = true;
      data_ = version_;
      return kNoError;
    case 2:
    case 4:
      data_ = 0;
      return kNoError;
    case 3:
      data_ = version_;
      return kNoError;
    case 5:
      data_ = 0x80;
      return kNoError;
    case 6:
      reads_state_ = reads_state_before_;
      told_version_ = false;
      return kNoError;
    default:
      return kBadInfo;
  }
}

bool Unit::breaks_silencer(std::int64_t foci_divider, std::int64_t modulation_divider) const {
  return strict_ && (modulation_divider < least_intensity_ || foci_divider < least_intensity_ ||
                     foci_divider < least_phase_);
}

int Unit::silencer(Bytes& in) {
  const int flag = in.u8(), intensity = in.u16(), phase = in.u16();
  must((flag & ~5) == 0, "the silencer has an unknown flag");
  must(intensity > 0 && phase > 0, "the silencer has 0 steps");
  if ((flag & 1) != 0) {
    strict_ = false;
    return kNoError;
  }
  const bool strict = strict_;
  const int least_intensity = least_intensity_, least_phase = least_phase_;
  strict_ = (flag & 4) != 0;
  least_intensity_ = intensity;
  least_phase_ = phase;
  if (breaks_silencer(foci_[at(foci_segment_)].shape.divider,
                      modulation_[at(modulation_segment_)].shape.divider)) {
    strict_ = strict;
    least_intensity_ = least_intensity;
    least_phase_ = least_phase;
    return kBadSilencer;
  }
  return kNoError;
}

int Unit::update(Chain& chain, int segment, const Shape& shape, int mode, std::uint64_t value) {
  if (mode == kSysTime && value < now_ + kMargin) return kMissedTime;
  must(mode != kGpio || value < 4, "there is no such GPIO input");
  chain.set(segment, shape, mode, value, tick_);
  chain.go_to(tick_, gpio_, now_);
  return kNoError;
}

int Unit::modulation(Bytes& in) {
  const int flag = in.u8();
  must((flag & ~15) == 0, "a modulation has an unknown flag");
  const int segment = (flag & kSegment1) != 0 ? 1 : 0;
  Modulation& m = modulation_[at(segment)];
  std::size_t count = 0;
  if ((flag & kBegin) != 0) {
    count = at(in.u8());
    const int mode = in.u8(), divider = in.u16(), rep = in.u16();
    const std::uint64_t value = in.number(8);
    must(divider > 0, "a modulation's divider is 0");
    must(count <= 254, "a first frame of modulation holds at most 254 samples");
    if (Chain::refuses(modulation_segment_, segment, rep, mode)) return kBadMode;
    if (breaks_silencer(foci_[at(foci_segment_)].shape.divider, divider)) return kBadSilencer;
    must(segment != modulation_chain_.segment(), "the modulation that plays is written over");
    if (mode != kNone) modulation_segment_ = segment;
    m.levels.clear();
    m.shape = {1, std::max(divider, 1), rep};
    modulation_mode_ = mode;
    modulation_value_ = value;
    writes_modulation_ = segment;
  } else {
    count = at(in.u16());
    must(writes_modulation_ == segment, "a modulation goes on that was not begun");
  }
  must(count > 0 && count <= in.left(), "a modulation's size does not fit its frame");
  for (std::size_t i = 0; i < std::min(count, in.left()); ++i)
    m.levels.push_back(static_cast<std::uint8_t>(in.u8()));
  must(m.levels.size() <= kStoredModulation, "a modulation is too long");
  if ((flag & kEnd) == 0) return kNoError;
  must(m.levels.size() >= 2, "a modulation has less than 2 samples");
  m.shape.cycle = static_cast<std::int64_t>(std::max<std::size_t>(m.levels.size(), 1));
  writes_modulation_ = -1;
  if ((flag & kUpdate) == 0) return kNoError;
  return update(modulation_chain_, segment, m.shape, modulation_mode_, modulation_value_);
}

int Unit::foci(Bytes& in) {
  const int flag = in.u8(), samples = in.u8(), segment = in.u8();
  must((flag & ~7) == 0, "foci have an unknown flag");
  must(segment <= 1, "there are two segments");
  if (segment > 1) return kNoError;
  Segment& s = foci_[at(segment)];
  if ((flag & kBegin) != 0) {
    const int mode = in.u8(), slots = in.u8(), speed = in.u16(), divider = in.u16(), rep = in.u16();
    must(in.number(4) == 0, "the padding of foci is not 0");
    const std::uint64_t value = in.number(8);
    must(slots >= 1 && slots <= 8, "foci per sample must be 1 to 8");
    must(divider > 0, "a divider of foci is 0");
    must(speed > 300 * 64 && speed < 380 * 64, "the speed of sound is not that of air");
    if (Chain::refuses(foci_segment_, segment, rep, mode)) return kBadMode;
    if (breaks_silencer(divider, modulation_[at(modulation_segment_)].shape.divider))
      return kBadSilencer;
    if (mode != kNone) foci_segment_ = segment;
    s.written = 0;
    s.foci = std::clamp(slots, 1, 8);
    s.sound_speed = std::max(speed, 1);
    s.gain = 0;
    // a segment that alternates keeps the length that it was set with
    s.shape.divider = std::max(divider, 1);
    s.shape.rep = rep;
    foci_mode_ = mode;
    foci_value_ = value;
    writes_foci_ = segment;
  } else {
    must(writes_foci_ == segment, "foci go on that were not begun");
  }
  const std::size_t count = at(samples) * at(s.foci);
  must(samples > 0 && 8 * count <= in.left(), "foci do not fit their frame");
  must(s.written + count <= kStoredFoci, "a segment has more than 65536 foci");
  s.words.resize(std::max(s.words.size(), s.written + count));
  for (std::size_t i = 0, n = std::min(count, in.left() / 8); i < n; ++i)
    s.words[s.written++] = in.number(8);
  if ((flag & kEnd) == 0) return kNoError;
  must(s.written >= 2, "a segment has less than 2 foci");
  must(foci_mode_ == kNone || (flag & kUpdate) != 0, "a change-over is announced and not made");
  const auto cycle = static_cast<std::int64_t>(s.written / at(std::max(s.foci, 1)));
  if ((flag & kUpdate) == 0)
    must(cycle == s.shape.cycle, "a segment that alternates has a new length");
  s.shape.cycle = std::max<std::int64_t>(cycle, 1);
  writes_foci_ = -1;
  if ((flag & kUpdate) == 0) return kNoError;
  return update(foci_chain_, segment, s.shape, foci_mode_, foci_value_);
}

int Unit::swap_foci(Bytes& in) {
  const int segment = in.u8(), mode = in.u8();
  must(in.number(5) == 0, "the padding of a change-over is not 0");
  const std::uint64_t value = in.number(8);
  must(segment <= 1, "there are two segments");
  if (segment > 1) return kNoError;
  const Segment& s = foci_[at(segment)];
  if (s.foci == 0) return kBadSegmentChange;
  if (Chain::refuses(foci_segment_, segment, s.shape.rep, mode)) return kBadMode;
  if (breaks_silencer(s.shape.divider, modulation_[at(modulation_segment_)].shape.divider))
    return kBadSilencer;
  foci_segment_ = segment;
  return update(foci_chain_, segment, s.shape, mode, value);
}

int Unit::gain(Bytes& in) {
  const int segment = in.u8(), flag = in.u8();
  must(in.u8() == 0, "the padding of a gain is not 0");
  must(segment <= 1 && flag <= 1, "a gain has an unknown segment or flag");
  if (segment > 1) return kNoError;
  Segment& s = foci_[at(segment)];
  s = {};
  s.shape = kCleared;
  for (int i = 0; i < 249; ++i) {
    in.u8();
    s.gain = std::max(s.gain, in.u8());
  }
  foci_segment_ = segment;
  if (flag != 0) return update(foci_chain_, segment, s.shape, kImmediate, 0);
  return kNoError;
}

Playing Unit::playing() const {
  Playing out;
  out.segment = foci_chain_.segment();
  out.index = foci_chain_.index();
  const Segment& s = foci_[at(out.segment)];
  out.divider = s.shape.divider;
  out.sound_speed = s.sound_speed;
  out.foci = s.foci;
  out.intensity = s.gain;
  const std::size_t first = static_cast<std::size_t>(out.index) * at(s.foci);
  for (std::size_t i = 0; i < at(s.foci) && first + i < s.words.size(); ++i)
    out.words[i] = s.words[first + i];
  if (s.foci > 0) out.intensity = static_cast<int>(out.words[0] >> 54 & 0xFF);
  const Modulation& m = modulation_[at(modulation_chain_.segment())];
  const auto index = static_cast<std::size_t>(modulation_chain_.index());
  out.modulation = ignores_modulation_ ? 255 : index < m.levels.size() ? m.levels[index] : 0;
  return out;
}

}  // namespace standin
