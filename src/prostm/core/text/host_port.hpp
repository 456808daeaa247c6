#pragma once
/// Network addresses in text form.

#include <cstdint>
#include <string>
#include <string_view>

namespace prostm {

/// A host's name, IPv4 or IPv6 address, without brackets, and a port.
struct HostPort {
  std::string host;
  std::uint16_t port = 0;

  /// Returns HOST:PORT, with brackets around an IPv6 address.
  std::string text() const;
};

/// Reads SCHEME://HOST, or SCHEME://HOST:PORT. IPv6 addresses must be in brackets. @param
/// usual_port default port.
/// @throws InputError with a sentence.
HostPort host_port(const std::string& text, std::string_view scheme, std::uint16_t usual_port);

}  // namespace prostm
