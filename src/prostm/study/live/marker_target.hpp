#pragma once
/// Where markers go: a UDP port, or a serial port.

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace prostm {

class MarkerTarget {
 public:
  virtual ~MarkerTarget() = default;
  /// Sends a marker without waiting: its line, or its code, as the target takes it. @return in a
  /// few words what is wrong there, or an empty text.
  virtual std::string send(std::string_view line, std::uint8_t code) = 0;
};

/// A target and what it was opened as.
struct OpenTarget {
  std::string address;
  std::unique_ptr<MarkerTarget> target;
};

/// Opens udp://HOST:PORT, which gets a datagram with the line for each marker, or serial://PATH or
/// serial://PATH:BAUD (115200 Bd, 8 bits, no parity, 1 stop bit), which gets a byte, the code.
/// @throws InputError: neither; the host is not known; the port cannot be opened, or is no serial
/// port.
std::unique_ptr<MarkerTarget> open_marker_target(const std::string& address);
/// Opens all, 8 at most. @throws InputError as for one, and for more.
std::vector<OpenTarget> open_marker_targets(const std::vector<std::string>& addresses);

}  // namespace prostm
