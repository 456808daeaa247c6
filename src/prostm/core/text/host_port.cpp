#include "prostm/core/text/host_port.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <system_error>

#include "prostm/core/input_error.hpp"

namespace prostm {

std::string HostPort::text() const {
  const bool is_v6 = host.find(':') != host.npos;
  return fmt::format("{}{}{}:{}", is_v6 ? "[" : "", host, is_v6 ? "]" : "", port);
}

HostPort host_port(const std::string& text, std::string_view scheme, std::uint16_t usual_port) {
  const auto wrong = [&](const std::string& what) {
    return InputError(
        fmt::format("{}: {}; it must be {}://HOST:PORT, for example {}://127.0.0.1:{}", text, what,
                    scheme, scheme, usual_port));
  };
  const std::string begin = fmt::format("{}://", scheme);
  if (text.rfind(begin, 0) != 0) throw wrong("does not begin with " + begin);
  const std::string rest = text.substr(begin.size());
  const bool bracketed = !rest.empty() && rest.front() == '[';
  const std::size_t end = bracketed ? rest.find(']') : rest.find(':');
  if (bracketed && end == rest.npos) throw wrong("has a bracket that does not close");
  HostPort address;
  address.port = usual_port;
  address.host = bracketed ? rest.substr(1, end - 1) : rest.substr(0, end);
  const std::size_t host_end = std::min(bracketed ? end + 1 : end, rest.size());
  if (address.host.empty()) throw wrong("names no host");
  if (address.host.find_first_of("/?#@ \t\\") != address.host.npos)
    throw wrong("has an invalid host");
  if (host_end == rest.size()) return address;
  const char* first = rest.data() + host_end + 1;
  const char* last = rest.data() + rest.size();
  const auto [stopped, error] = std::from_chars(first, last, address.port);
  if (rest[host_end] != ':' || error != std::errc() || stopped != last || address.port == 0)
    throw wrong("has a port that is not a number from 1 to 65535");
  return address;
}

}  // namespace prostm
