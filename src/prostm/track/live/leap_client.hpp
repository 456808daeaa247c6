#pragma once
/// Hands from a Leap Motion service, or from Ultraleap's WebSocket bridge, over its WebSocket.

#include <memory>
#include <string>
#include <string_view>

#include "prostm/core/text/host_port.hpp"
#include "prostm/track/live/live_tracker.hpp"

namespace prostm {

/// Says which program must run where a tracker is to be reached.
std::string_view leap_needs();

/// Reads `leap://HOST:PORT`; without `:PORT` it is 6437, IPv6 addresses stand in brackets.
/// @throws InputError with a sentence.
HostPort leap_address(const std::string& text);

/// A WebSocket client of protocol version 6 on its own thread: connects to `address`, tells the
/// service that it reads in the background and that the device lies on a desk, and takes in
/// frames. When nothing answers, the connection is lost, or nothing came for 2 s, it tries again,
/// first after 50 ms and then after up to 1 s. Frames and hands that leap_message() refuses are
/// dropped and counted, and so are frames with a time that was seen already (StampClock).
/// @throws InputError if `address.host` is neither an address nor a known host name.
std::unique_ptr<LiveTracker> make_leap_tracker(const HostPort& address);

/// Result of a look for a tracker.
struct TrackerFinding {
  bool found = false;
  std::string words;  ///< what is there; or what is missing and what to do
};

/// Looks whether a service answers at `address`, speaks the protocol, and sends frames, for
/// `seconds` at most, apart from the time that a host's name takes.
/// @throws InputError as make_leap_tracker() does.
TrackerFinding look_for_leap(const HostPort& address, double seconds = 1.0);

}  // namespace prostm
