#pragma once
/// Finds AUTD3 units on a network and numbers them.

#include <array>
#include <stop_token>
#include <string>
#include <vector>

#include "prostm/device/autd3_sdk/detail/autd3_sdk_wire.hpp"
#include "prostm/device/autd3_sdk/detail/udp_socket.hpp"

namespace prostm::sdk {

/// Where units are looked for: the group of all nodes on an interface, or a simulator's address.
/// @param text %INTERFACE or [IPv6], with :PORT if it is not the usual one.
/// @throws std::invalid_argument with a sentence.
UdpAddress group_address(const std::string& text);

/// Says in clauses what to look after where nobody answers.
std::string nobody_words(const UdpAddress& group);

struct Unit {
  UdpAddress address;
  UnitInfo info;
};

/// Units are numbered along their chain, from the host on: each keeps those behind it from hearing
/// the group until it has a number and is told to let them. Functions return in a clause what went
/// wrong, empty if nothing did. Not for several threads.
class Discovery {
 public:
  /// @param socket open, outlives this.
  Discovery(UdpSocket& socket, const UdpAddress& group) : socket_(socket), group_(group) {}

  /// Takes all units' numbers back and numbers them anew.
  std::string number(std::vector<Unit>& units, const std::stop_token& stop);
  /// Starts the common clock and waits until all units keep it.
  std::string start_clock(std::vector<Unit>& units, const std::stop_token& stop);
  /// Asks who is there, and changes nothing. Units behind one that has no number do not hear it.
  std::vector<Unit> who_is_there(UdpSocket::Clock::duration patience);
  /// Version that an answer of another wire version had; 0 if there was no such answer.
  int other_version() const { return other_version_; }

 private:
  using Clock = UdpSocket::Clock;
  struct Answer {
    UdpAddress from;
    std::uint8_t status = kOk;
    UnitInfo info;
    bool link = false;  // to a unit downstream
  };

  void ask(const UdpAddress& to, Datagram& d, Kind kind);
  bool next(Answer& answer, Kind kind, Clock::time_point end);
  bool exchange(const UdpAddress& to, Kind kind, Answer& answer);
  bool reset(const std::stop_token& stop);
  int discover(Answer& answer);
  std::string give_number(const UdpAddress& to, Unit& unit);
  bool release_stale(const std::vector<Unit>& units);

  UdpSocket& socket_;
  const UdpAddress group_;
  std::uint16_t id_ = 0;
  std::uint8_t unit_ = 0;  // for the next AssignId
  int other_version_ = 0;
  std::array<std::uint8_t, kMostDatagram> in_{};
};

}  // namespace prostm::sdk
