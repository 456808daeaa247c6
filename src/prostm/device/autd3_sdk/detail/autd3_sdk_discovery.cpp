#include "prostm/device/autd3_sdk/detail/autd3_sdk_discovery.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <net/if.h>
#include <netdb.h>
#include <netinet/in.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <stdexcept>
#include <thread>

namespace prostm::sdk {
namespace {

using std::chrono::milliseconds;

constexpr int kTries = 3;
constexpr milliseconds kAnswer{200}, kStale{60}, kLinger{10}, kPoll{10};
// units reset their numbers 20 ms after the request
constexpr milliseconds kSettle{120};
constexpr std::chrono::seconds kNumberTime{10}, kClockTime{10};
constexpr std::size_t kMostUnits = 255;
constexpr std::uint8_t kInStep = kClockLocked | kSyncReady;

constexpr std::array<std::uint8_t, 16> kAllNodes = {0xFF, 0x02, 0, 0, 0, 0, 0, 0,
                                                    0,    0,    0, 0, 0, 0, 0, 1};

std::uint16_t port_of(const std::string& text, const std::string& digits) {
  std::uint16_t port = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), port);
  if (error != std::errc() || end != digits.data() + digits.size() || port == 0)
    throw std::invalid_argument("autd3-sdk://" + text +
                                " has a port that is not a number from 1 to 65535");
  return port;
}

/// Returns the multicast group of all nodes on an interface.
UdpAddress on_interface(const std::string& text, const std::string& name) {
  UdpAddress address{kAllNodes, kPort, ::if_nametoindex(name.c_str())};
  if (address.scope == 0)
    throw std::invalid_argument("autd3-sdk://" + text + ": there is no network interface '" + name +
                                "'; 'ip link' lists the interfaces");
  return address;
}

UdpAddress numeric(const std::string& text, const std::string& host) {
  addrinfo hints{};
  hints.ai_family = AF_INET6;
  hints.ai_socktype = SOCK_DGRAM;
  hints.ai_flags = AI_NUMERICHOST;
  addrinfo* found = nullptr;
  if (::getaddrinfo(host.c_str(), nullptr, &hints, &found) != 0)
    throw std::invalid_argument("autd3-sdk://" + text +
                                " must name a network interface, such as autd3-sdk://%eth0, or an "
                                "IPv6 address in brackets, such as autd3-sdk://[::1]:44336");
  sockaddr_in6 raw{};
  std::memcpy(&raw, found->ai_addr, sizeof(raw));
  ::freeaddrinfo(found);
  UdpAddress address{{}, kPort, raw.sin6_scope_id};
  std::memcpy(address.host.data(), &raw.sin6_addr, address.host.size());
  return address;
}

bool wait(milliseconds time, const std::stop_token& stop) {
  const auto end = UdpSocket::Clock::now() + time;
  while (UdpSocket::Clock::now() < end && !stop.stop_requested())
    std::this_thread::sleep_for(milliseconds(1));
  return !stop.stop_requested();
}

}  // namespace

UdpAddress group_address(const std::string& text) {
  const bool bracketed = !text.empty() && text.front() == '[';
  const std::size_t end = bracketed ? text.find(']') : text.find(':');
  const std::string host =
      bracketed ? text.substr(1, end == text.npos ? end : end - 1) : text.substr(0, end);
  const std::string rest = end == text.npos ? "" : text.substr(bracketed ? end + 1 : end);
  UdpAddress address = !bracketed && host.size() > 1 && host.front() == '%'
                           ? on_interface(text, host.substr(1))
                           : numeric(text, bracketed && end != text.npos ? host : "");
  if (!rest.empty()) address.port = port_of(text, rest.front() == ':' ? rest.substr(1) : rest);
  return address;
}

std::string nobody_words(const UdpAddress& group) {
  if (!group.is_multicast())
    return fmt::format("start the AUTD3 SDK's simulator (port {}), and check the address", kPort);
  return fmt::format(
      "switch the units on, plug the first one into this interface, let UDP from fe80::/10, port "
      "{}, through the firewall, and use a network switch without MLD snooping",
      kPort);
}

void Discovery::ask(const UdpAddress& to, Datagram& d, Kind kind) {
  ++id_;
  if (kind == Kind::AssignId) {
    assign_id(d, id_, unit_, unit_ == 0);
  } else if (kind == Kind::SetTime) {
    set_time(d, id_, 0);
  } else {
    begin(d, kind, id_);
  }
  socket_.send(to, d.bytes());
}

/// Waits for an answer to the last question.
bool Discovery::next(Answer& answer, Kind kind, Clock::time_point end) {
  for (;;) {
    const std::size_t size = socket_.receive(in_, answer.from, end);
    if (size == 0) return false;
    const std::span<const std::uint8_t> bytes(in_.data(), size);
    const int version = version_of(bytes);
    if (version != 0 && version != kVersion) other_version_ = version;
    const std::optional<Reply> reply = read_reply(bytes);
    if (!reply || reply->kind != kind || reply->id != id_) continue;
    answer.status = reply->status;
    answer.info = read_unit_info(*reply).value_or(UnitInfo());
    answer.link = !reply->body.empty() && reply->body.front() != 0;
    return true;
  }
}

/// Sends a request to a single unit until it answers, a few times at most.
bool Discovery::exchange(const UdpAddress& to, Kind kind, Answer& answer) {
  Datagram d;
  for (int i = 0; i < kTries; ++i) {
    ask(to, d, kind);
    if (next(answer, kind, Clock::now() + kAnswer)) return true;
  }
  return false;
}

bool Discovery::reset(const std::stop_token& stop) {
  Datagram d;
  ask(group_, d, Kind::ResetId);
  return wait(kSettle, stop);
}

/// Finds the next unit without a number. @return how many answered: there should be one.
int Discovery::discover(Answer& answer) {
  Datagram d;
  ask(group_, d, Kind::Discover);
  if (!next(answer, Kind::Discover, Clock::now() + kAnswer)) return 0;
  Answer other;
  const Clock::time_point end = Clock::now() + kLinger;
  int count = 1;
  while (next(other, Kind::Discover, end)) count += other.from.same_end(answer.from) ? 0 : 1;
  return count;
}

std::string Discovery::give_number(const UdpAddress& to, Unit& unit) {
  Answer answer;
  if (exchange(to, Kind::AssignId, answer)) {
    if (answer.status != kOk) return status_words(answer.status);
    unit.address = answer.from;
    return {};
  }
  // the answer may have been lost, and the unit's address changes with its number
  for (const Unit& found : who_is_there(kAnswer)) {
    if (found.info.unit != unit_ || (found.info.flags & kAssigned) == 0) continue;
    unit.address = found.address;
    return {};
  }
  return "does not answer when it is given its number";
}

/// Resets units that have kept an old number. @return whether there were any.
bool Discovery::release_stale(const std::vector<Unit>& units) {
  bool any = false;
  for (const Unit& found : who_is_there(kStale)) {
    const auto is_it = [&](const Unit& unit) { return unit.address.same_end(found.address); };
    if ((found.info.flags & kAssigned) == 0 || std::any_of(units.begin(), units.end(), is_it))
      continue;
    Datagram d;
    ask(found.address, d, Kind::ResetId);
    any = true;
  }
  return any;
}

std::string Discovery::number(std::vector<Unit>& units, const std::stop_token& stop) {
  const Clock::time_point end = Clock::now() + kNumberTime;
  units.clear();
  if (!reset(stop)) return "was stopped";
  bool more = true;
  for (int empty = 0; more && Clock::now() < end;) {
    if (stop.stop_requested()) return "was stopped";
    Answer answer;
    const int count = discover(answer);
    if (count > 1)
      return fmt::format(
          "has {} units that answer at once; boards must be in one chain, the first "
          "at the host, so unplug one of two cables",
          count);
    if (count == 0) {
      const bool stale = release_stale(units);
      if (++empty == kTries || (units.empty() && !stale)) break;
      if (stale) wait(kSettle, stop);
      continue;
    }
    if (answer.status != kOk)
      return fmt::format("unit {} {}", units.size(), status_words(answer.status));
    if (units.size() == kMostUnits) return "has more than 255 units";
    unit_ = static_cast<std::uint8_t>(units.size());
    Unit unit;
    const UdpAddress before = answer.from;
    if (std::string why = give_number(before, unit); !why.empty())
      return fmt::format("unit {} {}", units.size(), why);
    if (!exchange(unit.address, Kind::UnblockDownstream, answer))
      return fmt::format("unit {} does not answer when it is told to unblock the next one",
                         units.size());
    if (answer.status != kOk)
      return fmt::format("unit {} {}", units.size(), status_words(answer.status));
    more = answer.link;
    units.push_back(unit);
  }
  if (units.empty() && other_version_ != 0)
    return fmt::format(
        "answers in wire version {}, but prostm speaks version {}; update the units' "
        "firmware to that of the AUTD3 SDK 0.10",
        other_version_, kVersion);
  if (units.empty()) return "does not answer";
  if (more)
    return fmt::format(
        "unit {} has a cable to a next unit that does not answer; switch all units "
        "off and on",
        units.size() - 1);
  return {};
}

std::string Discovery::start_clock(std::vector<Unit>& units, const std::stop_token& stop) {
  Answer answer;
  if (!exchange(units.front().address, Kind::SetTime, answer))
    return "unit 0 does not answer when it is told the time";
  if (answer.status != kOk) return "unit 0 " + status_words(answer.status);
  const Clock::time_point end = Clock::now() + kClockTime;
  std::size_t late = 0;
  while (Clock::now() < end) {
    if (!wait(kPoll, stop)) return "was stopped";
    late = units.size();
    for (std::size_t u = 0; u < units.size(); ++u) {
      if (!exchange(units[u].address, Kind::ReadUnitInfo, answer))
        return fmt::format("unit {} does not answer any more", u);
      units[u].info = answer.info;
      if (answer.info.unit != u) return fmt::format("unit {} {}", u, status_words(kNotAssigned));
      if ((answer.info.flags & kInStep) != kInStep) late = std::min(late, u);
    }
    if (late == units.size()) return {};
  }
  return fmt::format(
      "unit {} does not synchronise to the common clock within 10 s; switch the units off and "
      "on, and check that no other device on the network is a PTP clock",
      late);
}

std::vector<Unit> Discovery::who_is_there(Clock::duration patience) {
  Datagram d;
  ask(group_, d, Kind::ReadUnitInfo);
  std::vector<Unit> units;
  Answer answer;
  const Clock::time_point end = Clock::now() + patience;
  while (next(answer, Kind::ReadUnitInfo, end)) {
    const auto is_it = [&](const Unit& unit) { return unit.address.same_end(answer.from); };
    if (std::none_of(units.begin(), units.end(), is_it))
      units.push_back({answer.from, answer.info});
  }
  return units;
}

}  // namespace prostm::sdk
