#pragma once
/// Hands from a Leap Motion service, or from Ultraleap's WebSocket bridge, over its WebSocket.

#include <memory>
#include <string>
#include <string_view>

#include "prostm/core/text/host_port.hpp"
#include "prostm/track/live/live_tracker.hpp"

namespace prostm {

/// Returns a clause that names the programs that can serve a Leap Motion tracker.
std::string_view leap_needs();

/// Parses `leap://HOST:PORT`; the default port is 6437, and IPv6 addresses are in brackets.
/// @throws InputError with a sentence.
HostPort leap_address(const std::string& text);

/// A WebSocket client of protocol version 6 on its own thread: connects to `address`, tells the
/// service that it reads in the background and that the device lies on a desk, and receives
/// frames. If nothing answers, the connection is lost, or no data arrives for 2 s, it reconnects,
/// first after 50 ms and later after up to 1 s. Frames and hands that leap_message() refuses are
/// dropped and counted, and so are frames with a repeated time stamp (StampClock).
/// @throws InputError if `address.host` is neither an address nor a known host name.
std::unique_ptr<LiveTracker> make_leap_tracker(const HostPort& address);

/// Result of probing for a tracker.
struct TrackerFinding {
  bool found = false;
  std::string words;  ///< what is there; or what is missing and what to do
};

/// Checks whether a service answers at `address`, speaks the protocol and sends frames. Takes at
/// most `seconds`, plus the time to resolve the host's name.
/// @throws InputError as make_leap_tracker() does.
TrackerFinding look_for_leap(const HostPort& address, double seconds = 1.0);

}  // namespace prostm
