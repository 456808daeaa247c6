#pragma once
/// Targets of markers: a UDP port, or a serial port.

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace prostm {

class MarkerTarget {
 public:
  virtual ~MarkerTarget() = default;
  /// Sends a marker without blocking: its line or its code, depending on the target. @return a
  /// short description of the problem, or an empty text.
  virtual std::string send(std::string_view line, std::uint8_t code) = 0;
};

/// A target and the address it was opened with.
struct OpenTarget {
  std::string address;
  std::unique_ptr<MarkerTarget> target;
};

/// Opens udp://HOST:PORT, which receives each marker's line as a datagram, or serial://PATH or
/// serial://PATH:BAUD (115200 Bd by default, 8 bits, no parity, 1 stop bit), which receives its
/// code as one byte. @throws InputError: another form of address; an unknown host; the port cannot
/// be opened, or is not a serial port.
std::unique_ptr<MarkerTarget> open_marker_target(const std::string& address);
/// Opens several targets, at most 8. @throws InputError as open_marker_target(), and for more than
/// 8.
std::vector<OpenTarget> open_marker_targets(const std::vector<std::string>& addresses);

}  // namespace prostm
