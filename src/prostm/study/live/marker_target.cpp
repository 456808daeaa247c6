#include "prostm/study/live/marker_target.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/serial_port.hpp>
#include <cerrno>
#include <charconv>
#include <cstring>

#include "prostm/core/input_error.hpp"
#include "prostm/core/text/host_port.hpp"

namespace prostm {
namespace {

namespace asio = boost::asio;
using Udp = asio::ip::udp;

constexpr std::string_view kUdp = "udp://", kSerial = "serial://";
constexpr std::uint16_t kUsualPort = 8480;
constexpr unsigned kUsualBaud = 115200;
constexpr std::size_t kMostTargets = 8;

[[noreturn]] void cannot_open(const std::string& address, const std::string& why) {
  throw InputError(fmt::format("--markers {} cannot be opened: {}", address, why));
}

class UdpTarget final : public MarkerTarget {
 public:
  explicit UdpTarget(const std::string& address) : socket_(context_) {
    const HostPort to = host_port(address, "udp", kUsualPort);
    boost::system::error_code wrong;
    const auto found = Udp::resolver(context_).resolve(to.host, std::to_string(to.port),
                                                       Udp::resolver::numeric_service, wrong);
    if (wrong) cannot_open(address, wrong.message());
    // connected, so that the system reports when nothing is listening
    const Udp::endpoint end = found.begin()->endpoint();
    if (!socket_.open(end.protocol(), wrong) && !socket_.connect(end, wrong))
      socket_.non_blocking(true, wrong);
    if (wrong) cannot_open(address, wrong.message());
  }

  std::string send(std::string_view line, std::uint8_t) override {
    std::string problem = refusal();  // a pending error of an earlier datagram would block this one
    boost::system::error_code wrong;
    socket_.send(asio::buffer(line.data(), line.size()), 0, wrong);
    if (wrong) return wrong.message();
    const std::string own = refusal();  // reported at once on this machine
    return own.empty() ? problem : own;
  }

 private:
  std::string refusal() {
    int error = 0;
    socklen_t size = sizeof(error);
    if (::getsockopt(socket_.native_handle(), SOL_SOCKET, SO_ERROR, &error, &size) != 0)
      return std::strerror(errno);
    if (error == 0) return {};
    return error == ECONNREFUSED ? "nothing is listening there" : std::strerror(error);
  }

  asio::io_context context_;
  Udp::socket socket_;
};

std::string problem_of(const boost::system::error_code& wrong) {
  if (wrong.value() == EACCES) return "permission denied; in Debian, join the group dialout";
  return wrong.value() == ENOTTY ? "it is not a serial port" : wrong.message();
}

class SerialTarget final : public MarkerTarget {
 public:
  explicit SerialTarget(const std::string& address) : port_(context_) {
    std::string path = address.substr(kSerial.size());
    unsigned baud = kUsualBaud;
    const std::size_t colon = path.rfind(':');
    if (colon != path.npos) {
      const char *first = path.data() + colon + 1, *last = path.data() + path.size();
      const auto [stopped, error] = std::from_chars(first, last, baud);
      if (error != std::errc() || stopped != last) {
        throw InputError(fmt::format(
            "--markers {} has a rate that is not a number; it must be serial://PATH:BAUD, for "
            "example serial:///dev/ttyUSB0:{}",
            address, kUsualBaud));
      }
      path.resize(colon);
    }
    boost::system::error_code wrong;
    if (port_.open(path, wrong)) cannot_open(address, problem_of(wrong));
    using Port = asio::serial_port_base;
    if (port_.set_option(Port::baud_rate(baud), wrong))
      cannot_open(address, fmt::format("{} Bd: {}", baud, wrong.message()));
    port_.set_option(Port::character_size(8), wrong);
    port_.set_option(Port::parity(Port::parity::none), wrong);
    port_.set_option(Port::stop_bits(Port::stop_bits::one), wrong);
    port_.set_option(Port::flow_control(Port::flow_control::none), wrong);
    if (wrong) cannot_open(address, wrong.message());
  }

  std::string send(std::string_view, std::uint8_t code) override {
    // opened in non-blocking mode
    if (::write(port_.native_handle(), &code, 1) == 1) return {};
    return errno == EAGAIN ? "its buffer is full" : std::strerror(errno);
  }

 private:
  asio::io_context context_;
  asio::serial_port port_;
};

}  // namespace

std::unique_ptr<MarkerTarget> open_marker_target(const std::string& address) {
  if (address.starts_with(kUdp)) return std::make_unique<UdpTarget>(address);
  if (address.starts_with(kSerial)) return std::make_unique<SerialTarget>(address);
  throw InputError(
      fmt::format("--markers {} must be udp://HOST:PORT or serial://PATH, for example "
                  "udp://127.0.0.1:{} or serial:///dev/ttyUSB0",
                  address, kUsualPort));
}

std::vector<OpenTarget> open_marker_targets(const std::vector<std::string>& addresses) {
  if (addresses.size() > kMostTargets) {
    throw InputError(fmt::format("--markers is given {} times; at most {} are allowed",
                                 addresses.size(), kMostTargets));
  }
  std::vector<OpenTarget> targets;
  for (const std::string& address : addresses)
    targets.push_back({address, open_marker_target(address)});
  return targets;
}

}  // namespace prostm
