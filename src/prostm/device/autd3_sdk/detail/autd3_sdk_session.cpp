#include "prostm/device/autd3_sdk/detail/autd3_sdk_session.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace prostm::sdk {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;

constexpr int kMostTries = 4;           // until the sequence is reset
constexpr milliseconds kHurry{2};       // between two bursts that are sent again early
constexpr milliseconds kNap{1};         // while waiting for room
constexpr milliseconds kStall{20};      // pause of our own thread after which units are not blamed
constexpr milliseconds kPatience{250};  // for a unit that answers to execute a frame
constexpr milliseconds kKnown{90};      // for units that have numbers to answer
constexpr milliseconds kProbe{50};
constexpr milliseconds kHalfSecond{500};
constexpr std::chrono::seconds kAlone{1};  // that a clock may run without synchronisation
constexpr int kFirstBeats = 3, kMostBeats = 30;

std::int64_t count_of(UdpSocket::Clock::time_point time) {
  return std::chrono::duration_cast<nanoseconds>(time.time_since_epoch()).count();
}

/// Timeout of an acknowledgement, longer after each try, so as not to congest a slow link.
milliseconds patience(int tries) {
  return Session::kAckTime * (1 << std::min(tries, 2));
}

std::string version_text(std::span<const std::uint8_t> v) {
  return fmt::format("{}.{}.{}", v[0], v[1], v[2]);
}

}  // namespace

Session::Session(const SessionSettings& settings)
    : settings_(settings), group_(group_address(settings.address)) {}

bool Session::fail(std::string clause) {
  problem_ = "autd3-sdk://" + settings_.address + " " + std::move(clause) + ".";
  failed_ = true;
  return false;
}

void Session::lose(std::size_t unit, const char* clause) noexcept {
  fail(fmt::format("is lost: unit {} {}", unit, clause));
}

std::string Session::number_units(const std::stop_token& stop) {
  if (std::string why = socket_.open(group_); !why.empty())
    return "cannot be used: " + why + "; switch the interface on, and IPv6 on it";
  Discovery discovery(socket_, group_);
  std::vector<Unit> units;
  if (std::string why = discovery.number(units, stop); !why.empty())
    return units.empty() && why == "does not answer" ? why + "; " + nobody_words(group_) : why;
  if (settings_.units != 0 && static_cast<int>(units.size()) != settings_.units)
    return fmt::format("has {} units, but the settings place {}; give each unit a pose",
                       units.size(), settings_.units);
  if (std::string why = discovery.start_clock(units, stop); !why.empty()) return why;
  settings_.units = static_cast<int>(units.size());
  peers_.assign(units.size(), Peer());
  for (std::size_t u = 0; u < units.size(); ++u) peers_[u].address = units[u].address;
  return {};
}

bool Session::open(const std::stop_token& stop) {
  is_open_ = false;
  if (std::string why = number_units(stop); !why.empty()) return fail(why);
  return resume();
}

bool Session::units_answer() {
  return !Discovery(socket_, group_).who_is_there(kProbe).empty();
}

bool Session::resume() {
  if (peers_.empty()) return false;
  const Clock::time_point now = Clock::now();
  failed_ = false;
  for (Peer& peer : peers_) {
    peer.oldest = peer.count = 0;
    peer.heard = peer.done_at = now;
    peer.alone = {};
    peer.reset = 0;
    reset(peer, now);
  }
  best_ = last_best_ = {};
  best_since_ = stepped_ = now;
  const auto waits = [](const Peer& peer) { return peer.reset != 0; };
  while (std::any_of(peers_.begin(), peers_.end(), waits)) {
    if (!step(now + kKnown)) return false;
    if (Clock::now() > now + kKnown)
      return fail("does not answer any more; " + nobody_words(group_));
  }
  is_open_ = prepare();
  return is_open_;
}

/// Clears the units, and sets their failsafe.
bool Session::prepare() {
  const auto simply = [&](Command command) {
    return post_all([&](Datagram& d) { frame(d, command); }) && finish();
  };
  if (!simply(Command::ReadFirmwareInfo)) return false;
  const std::span<const std::uint8_t> versions(peers_.front().versions);
  firmware_ =
      "CPU " + version_text(versions.first(3)) + ", FPGA " + version_text(versions.subspan(3));
  const auto configure = [&](Datagram& d) { cpu_config(d, settings_.failsafe_ms); };
  if (!simply(Command::Clear) || !simply(Command::Synchronize) || !post_all(configure) || !finish())
    return false;
  for (int beats = 0; beats < kFirstBeats || best_.trip == Clock::duration::max(); ++beats) {
    if (!listen(Clock::now() + kHeartbeat)) return false;
    if (beats == kMostBeats) return fail("loses all heartbeats; check the network");
  }
  return read_state();
}

void Session::close() noexcept {
  if (is_open_ && !failed_ && post_all([](Datagram& d) { frame(d, Command::Clear); })) finish();
  is_open_ = false;
}

Datagram* Session::room(std::size_t unit) noexcept {
  Peer& peer = peers_[unit];
  while (peer.count == kAhead || peer.reset != 0)
    if (!step(Clock::now() + kNap)) return nullptr;
  return failed_ ? nullptr : &peer.sent(peer.count).frame;
}

void Session::post(std::size_t unit) noexcept {
  Peer& peer = peers_[unit];
  Sent& sent = peer.sent(peer.count);
  sent.id = ++id_;
  sent.at = Clock::now();
  sent.frame.renumber(sent.id, static_cast<std::uint8_t>(peer.sequence + peer.count));
  if (peer.count++ == 0) {
    peer.tries = 0;
    peer.done_at = sent.at;
  }
  socket_.send(peer.address, sent.frame.bytes());
}

bool Session::finish() noexcept {
  const auto busy = [](const Peer& peer) { return peer.count > 0 || peer.reset != 0; };
  while (!failed_ && std::any_of(peers_.begin(), peers_.end(), busy)) step(Clock::now() + kNap);
  return !failed_;
}

bool Session::listen(Clock::time_point until) noexcept {
  do {
    if (!step(until)) return false;
  } while (Clock::now() < until);
  return true;
}

bool Session::read_state() noexcept {
  return post_all([](Datagram& d) { frame(d, Command::ReadFpgaState); }) && finish();
}

bool Session::activate(int bank) noexcept {
  // a unit executes frames in sequence, so the bank is complete by then; but while the form of the
  // command is unknown, an earlier frame's refusal must not be taken for its own
  if (!margin_known_ && !finish()) return false;
  for (int form = 0; form < 2; ++form) {
    refusal_ = kNoError;
    const auto write = [&](Datagram& d) { sdk::activate(d, bank, margin_field_); };
    if (!post_all(write) || !finish()) return false;
    if (refusal_ == kNoError) {
      margin_known_ = true;
      return true;
    }
    margin_field_ = !margin_field_;
  }
  return fail(fmt::format("unit {} {}", refused_unit_, error_words(refusal_)));
}

double Session::measure() {
  constexpr int kMeasured = 28, kRounds = 3;  // frames per round, and rounds
  const std::vector<SlotWord> silent(kFociPerFrame);
  double best = 0.0;
  for (int round = 0; round < kRounds; ++round) {
    const Clock::time_point start = Clock::now();
    for (int i = 0; i < kMeasured; ++i)
      if (!post_all([&](Datagram& d) { write_foci(d, 1, 0, silent); })) return 0.0;
    if (!finish()) return 0.0;
    const std::chrono::duration<double, std::milli> time = Clock::now() - start;
    best = std::max(best, kMeasured / time.count());
  }
  return best;
}

bool Session::set_silencer(int steps) noexcept {
  return post_all([&](Datagram& d) { silencer(d, steps); }) && finish();
}

bool Session::release_failsafe() noexcept {
  refusal_ = kNoError;
  return post_all([](Datagram& d) { frame(d, Command::ReleaseFailsafe); }) && finish() &&
         refusal_ == kNoError;
}

/// Receives until an answer arrives or until a time, then sends the messages that are due.
bool Session::step(Clock::time_point until) noexcept {
  if (failed_) return false;
  Clock::time_point now = Clock::now();
  if (now - stepped_ > kStall)
    for (Peer& peer : peers_) peer.heard = peer.done_at = now;
  UdpAddress from;
  Clock::time_point end = std::min(until, next_due());
  // process all received answers before anything counts as late
  while (const std::size_t size = socket_.receive(in_, from, end)) {
    const std::optional<Reply> reply = read_reply({in_.data(), size});
    now = Clock::now();
    if (reply) hear(*reply, from, now);
    if (failed_ || now > until) break;
    end = now;
  }
  stepped_ = Clock::now();
  service_peers(stepped_);
  return !failed_;
}

Session::Clock::time_point Session::next_due() const {
  Clock::time_point due = Clock::time_point::max();
  for (const Peer& peer : peers_) {
    due = std::min({due, peer.beat_at + kHeartbeat, peer.heard + kLost});
    if (peer.reset != 0) due = std::min(due, peer.reset_at + kAckTime);
    if (peer.reset == 0 && peer.count > 0)
      due = std::min(due, peer.ring[peer.oldest].at + patience(peer.tries));
  }
  return due;
}

void Session::service_peers(Clock::time_point now) noexcept {
  if (now - best_since_ > kHalfSecond && best_.trip != Clock::duration::max()) {
    last_best_ = best_;
    best_ = {};
    best_since_ = now;
  }
  for (Peer& peer : peers_) {
    if (now - peer.heard > kLost) {
      lose(static_cast<std::size_t>(&peer - peers_.data()),
           "was silent for 100 ms; check its power and its cable");
      return;
    }
    if ((peer.count > 0 || peer.reset != 0) && now - peer.done_at > kPatience) {
      lose(static_cast<std::size_t>(&peer - peers_.data()),
           "answers, but does not execute frames; switch it off and on");
      return;
    }
    if (now - peer.beat_at >= kHeartbeat) {
      Datagram d;
      begin(d, Kind::Heartbeat, ++id_);
      peer.beat = id_;
      peer.beat_at = now;
      socket_.send(peer.address, d.bytes());
    }
    if (peer.reset != 0) {
      if (now - peer.reset_at >= kAckTime) reset(peer, now);
    } else if (peer.count > 0 && now - peer.ring[peer.oldest].at >= patience(peer.tries)) {
      if (++peer.tries > kMostTries) {
        reset(peer, now);
      } else {
        send_again(peer, now);
      }
    }
  }
}

/// Resends all frames in flight, from the oldest on: a unit executes them only in sequence.
void Session::send_again(Peer& peer, Clock::time_point now) noexcept {
  peer.resent = now;
  for (std::size_t i = 0; i < peer.count; ++i) {
    Sent& sent = peer.sent(i);
    sent.id = ++id_;
    sent.at = now;
    sent.frame.renumber(sent.id, static_cast<std::uint8_t>(peer.sequence + i));
    socket_.send(peer.address, sent.frame.bytes());
    ++sent_again_;
  }
}

/// Makes a unit restart its sequence.
void Session::reset(Peer& peer, Clock::time_point now) noexcept {
  Datagram d;
  frame(d, Command::Reset);
  // keep the id, so that a slow answer to the first Reset is recognised
  if (peer.reset == 0) peer.reset = ++id_ == 0 ? ++id_ : id_;
  d.renumber(peer.reset, 0);
  peer.reset_at = now;
  socket_.send(peer.address, d.bytes());
}

void Session::hear(const Reply& reply, const UdpAddress& from, Clock::time_point now) noexcept {
  const auto is_it = [&](const Peer& peer) { return peer.address.same_end(from); };
  const auto peer = std::find_if(peers_.begin(), peers_.end(), is_it);
  if (peer == peers_.end()) return;
  const std::optional<FrameReply> answer = read_frame_reply(reply);
  if (!answer) return;
  peer->heard = now;
  const auto unit = static_cast<std::size_t>(peer - peers_.begin());
  watch(unit, *answer, now);
  if (failed_) return;
  if (unit == 0 && reply.kind == Kind::Heartbeat && reply.id == peer->beat)
    keep_time(*peer, *answer, now);
  acknowledge(*peer, reply, *answer, now);
}

/// Checks that a unit still has its number and is synchronised.
void Session::watch(std::size_t unit, const FrameReply& answer, Clock::time_point now) noexcept {
  Peer& peer = peers_[unit];
  if (answer.unit != unit || (answer.flags & kAssigned) == 0) {
    lose(unit, status_words(kNotAssigned).c_str());
    return;
  }
  if ((answer.flags & kClockLocked) != 0) {
    peer.alone = {};
  } else if (peer.alone == Clock::time_point()) {
    peer.alone = now;
  } else if (now - peer.alone > kAlone) {
    lose(unit, "has not kept the common time for 1 s; check its cable");
  }
}

void Session::keep_time(const Peer& peer, const FrameReply& answer,
                        Clock::time_point now) noexcept {
  const Clock::duration trip = now - peer.beat_at;
  if (trip > best_.trip) return;
  best_.trip = trip;
  best_.offset = static_cast<std::int64_t>(answer.time) - count_of(peer.beat_at + trip / 2);
}

std::int64_t Session::unit_time(Clock::time_point host) const {
  return count_of(host) + (best_.trip <= last_best_.trip ? best_ : last_best_).offset;
}

Session::Clock::time_point Session::host_time(std::int64_t unit) const {
  const std::int64_t offset = (best_.trip <= last_best_.trip ? best_ : last_best_).offset;
  return Clock::time_point(std::chrono::duration_cast<Clock::duration>(nanoseconds(unit - offset)));
}

/// Removes the frames that a unit has executed, up to the one that it acknowledges.
void Session::acknowledge(Peer& peer, const Reply& reply, const FrameReply& answer,
                          Clock::time_point now) noexcept {
  if (peer.reset != 0) {
    if (reply.kind != Kind::Frame || reply.id != peer.reset || answer.ack != kResetAck) return;
    peer.reset = 0;
    peer.sequence = 0;
    peer.tries = 0;
    send_again(peer, now);
    return;
  }
  const std::size_t done = static_cast<std::uint8_t>(answer.ack - peer.sequence) + 1U;
  if (done <= peer.count) {
    take(peer, peer.sent(done - 1).frame.command(), answer);
    peer.oldest = (peer.oldest + done) % peer.ring.size();
    peer.count -= done;
    peer.done_at = now;
    peer.sequence = static_cast<std::uint8_t>(peer.sequence + done);
    peer.tries = 0;
    return;
  }
  // a frame that was received but not executed: the unit lacks an earlier one
  for (std::size_t i = 1; i < peer.count; ++i)
    if (reply.kind == Kind::Frame && reply.id == peer.sent(i).id && now - peer.resent > kHurry)
      send_again(peer, now);
}

/// Handles the result of a frame.
void Session::take(Peer& peer, Command command, const FrameReply& answer) noexcept {
  if (answer.error == kNoError) {
    if (command == Command::ReadFpgaState && !answer.data.empty()) peer.state = answer.data[0];
    if (command == Command::ReadFirmwareInfo && answer.data.size() >= peer.versions.size())
      std::copy_n(answer.data.begin(), peer.versions.size(), peer.versions.begin());
    return;
  }
  refusal_ = answer.error;
  refused_unit_ = static_cast<int>(&peer - peers_.data());
  const bool asked =
      command == Command::ActivatePatternBank && !margin_known_ && answer.error == kInvalidPayload;
  const bool for_now =
      command == Command::ReleaseFailsafe && answer.error == kFailsafeConditionActive;
  if (!asked && !for_now) fail(fmt::format("unit {} {}", refused_unit_, error_words(answer.error)));
}

}  // namespace prostm::sdk
