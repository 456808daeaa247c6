#pragma once
/// Finds AUTD3 units on a network and numbers them.

#include <array>
#include <stop_token>
#include <string>
#include <vector>

#include "prostm/device/autd3_sdk/detail/autd3_sdk_wire.hpp"
#include "prostm/device/autd3_sdk/detail/udp_socket.hpp"

namespace prostm::sdk {

/// Returns the address to search: the multicast group of all nodes on an interface, or a simulator.
/// @param text %INTERFACE or [IPv6], with :PORT if it is not the default.
/// @throws std::invalid_argument with a sentence.
UdpAddress group_address(const std::string& text);

/// Returns advice, in clauses, for the case that no unit answers.
std::string nobody_words(const UdpAddress& group);

struct Unit {
  UdpAddress address;
  UnitInfo info;
};

/// Units are numbered along their chain, starting at the host: each unit blocks the group's
/// messages to the units behind it until it has a number and is told to unblock them. Functions
/// return a clause that describes a failure; empty on success. Not thread-safe.
class Discovery {
 public:
  /// @param socket is open, and outlives this.
  Discovery(UdpSocket& socket, const UdpAddress& group) : socket_(socket), group_(group) {}

  /// Resets the numbers of all units and numbers them again.
  std::string number(std::vector<Unit>& units, const std::stop_token& stop);
  /// Starts the common clock and waits until all units are synchronised to it.
  std::string start_clock(std::vector<Unit>& units, const std::stop_token& stop);
  /// Lists the units that answer, without changing anything. Units behind an unnumbered one are not
  /// reached.
  std::vector<Unit> who_is_there(UdpSocket::Clock::duration patience);
  /// Wire version of an answer in another version than ours; 0 if there was none.
  int other_version() const { return other_version_; }

 private:
  using Clock = UdpSocket::Clock;
  struct Answer {
    UdpAddress from;
    std::uint8_t status = kOk;
    UnitInfo info;
    bool link = false;  // whether a cable leads to a unit downstream
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
