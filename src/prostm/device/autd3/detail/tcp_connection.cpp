#include "prostm/device/autd3/detail/tcp_connection.hpp"

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>

namespace prostm {
namespace {

using Clock = std::chrono::steady_clock;

/// Waits until a socket can be read or written; false at `end`.
bool wait(int socket, short events, Clock::time_point end) {
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::nanoseconds>(end - Clock::now());
    if (left.count() <= 0) return false;
    constexpr std::int64_t kSecond = 1'000'000'000;
    const timespec time{static_cast<time_t>(left.count() / kSecond),
                        static_cast<long>(left.count() % kSecond)};
    pollfd waiting{socket, events, 0};
    const int ready = ::ppoll(&waiting, 1, &time, nullptr);
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) return false;
  }
}

bool should_retry() {
  return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
}

/// Connects to one address. @return the socket, or −1 with errno.
int connect_to(const addrinfo& to, Clock::time_point end) {
  const int socket = ::socket(to.ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (socket < 0) return -1;
  const int at_once = 1;
  ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof(at_once));
  int error = ::connect(socket, to.ai_addr, to.ai_addrlen) == 0 ? 0 : errno;
  if (error == EINPROGRESS) {
    error = ETIMEDOUT;
    socklen_t size = sizeof(error);
    if (wait(socket, POLLOUT, end)) ::getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size);
  }
  if (error == 0) return socket;
  ::close(socket);
  errno = error;
  return -1;
}

}  // namespace

std::string TcpConnection::open(const HostPort& address, Duration patience) {
  close();
  const Clock::time_point end = Clock::now() + patience;
  addrinfo wanted{};
  wanted.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const std::string port = std::to_string(address.port);
  if (::getaddrinfo(address.host.c_str(), port.c_str(), &wanted, &found) != 0)
    return "the host " + address.host + " is unknown";
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> all(found, &::freeaddrinfo);
  for (const addrinfo* to = found; to != nullptr && socket_ < 0; to = to->ai_next)
    socket_ = connect_to(*to, end);
  if (socket_ >= 0) return {};
  if (errno == ECONNREFUSED) return "nothing listens there";
  if (errno == ETIMEDOUT) return "nothing answers there";
  return std::strerror(errno);
}

void TcpConnection::close() noexcept {
  if (socket_ >= 0) ::close(socket_);
  socket_ = -1;
}

bool TcpConnection::send(std::span<const std::uint8_t> bytes, Duration patience) noexcept {
  const Clock::time_point end = Clock::now() + patience;
  while (!bytes.empty()) {
    const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(sent));
    } else if (!should_retry() || !wait(socket_, POLLOUT, end)) {
      return false;
    }
  }
  return true;
}

bool TcpConnection::receive(std::span<std::uint8_t> bytes, Duration patience) noexcept {
  const Clock::time_point end = Clock::now() + patience;
  while (!bytes.empty()) {
    const ssize_t got = ::recv(socket_, bytes.data(), bytes.size(), 0);
    if (got > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(got));
    } else if (got == 0 || !should_retry() || !wait(socket_, POLLIN, end)) {
      return false;
    }
  }
  return true;
}

}  // namespace prostm
