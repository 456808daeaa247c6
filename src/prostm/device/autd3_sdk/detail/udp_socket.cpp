#include "prostm/device/autd3_sdk/detail/udp_socket.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <ifaddrs.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>

namespace prostm {
namespace {

sockaddr_in6 raw(const UdpAddress& address) {
  sockaddr_in6 out{};
  out.sin6_family = AF_INET6;
  out.sin6_port = htons(address.port);
  out.sin6_scope_id = address.scope;
  std::memcpy(&out.sin6_addr, address.host.data(), address.host.size());
  return out;
}

/// The link-local address of an interface, with port 0; all zero if it has none.
UdpAddress own_address(std::uint32_t scope) {
  UdpAddress own;
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) != 0) return own;
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> all(first, freeifaddrs);
  for (const ifaddrs* i = all.get(); i != nullptr; i = i->ifa_next) {
    if (i->ifa_addr == nullptr || i->ifa_addr->sa_family != AF_INET6) continue;
    sockaddr_in6 found{};
    std::memcpy(&found, i->ifa_addr, sizeof(found));
    if (!IN6_IS_ADDR_LINKLOCAL(&found.sin6_addr) || found.sin6_scope_id != scope) continue;
    std::memcpy(own.host.data(), &found.sin6_addr, own.host.size());
    own.scope = scope;
  }
  return own;
}

bool is_loopback(const UdpAddress& address) {
  const sockaddr_in6 a = raw(address);
  return IN6_IS_ADDR_LOOPBACK(&a.sin6_addr);
}

constexpr UdpAddress kAnyLoopback{{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1}, 0, 0};

}  // namespace

std::string UdpSocket::open(const UdpAddress& peer) {
  close();
  UdpAddress own;
  if (is_loopback(peer)) {
    own = kAnyLoopback;
  } else if (peer.scope != 0) {
    own = own_address(peer.scope);
    if (own.host == UdpAddress().host) return "the interface has no link-local IPv6 address";
  }
  socket_ = ::socket(AF_INET6, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const sockaddr_in6 bound = raw(own);
  const int only_v6 = 1, scope = static_cast<int>(peer.scope), hops = 1;
  // room for a whole block for several units
  const int buffer = 1 << 20;
  const auto fails = [&] {
    if (socket_ < 0) return true;
    ::setsockopt(socket_, SOL_SOCKET, SO_SNDBUF, &buffer, sizeof(buffer));
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &buffer, sizeof(buffer));
    ::setsockopt(socket_, IPPROTO_IPV6, IPV6_V6ONLY, &only_v6, sizeof(only_v6));
    ::setsockopt(socket_, IPPROTO_IPV6, IPV6_MULTICAST_HOPS, &hops, sizeof(hops));
    if (scope != 0 &&
        ::setsockopt(socket_, IPPROTO_IPV6, IPV6_MULTICAST_IF, &scope, sizeof(scope)) != 0)
      return true;
    return ::fcntl(socket_, F_SETFL, O_NONBLOCK) != 0 ||
           ::bind(socket_, reinterpret_cast<const sockaddr*>(&bound), sizeof(bound)) != 0;
  };
  if (!fails()) return {};
  const std::string why = std::strerror(errno);
  close();
  return why;
}

void UdpSocket::close() noexcept {
  if (socket_ >= 0) ::close(socket_);
  socket_ = -1;
}

bool UdpSocket::send(const UdpAddress& to, std::span<const std::uint8_t> bytes) noexcept {
  if (socket_ < 0) return false;
  const sockaddr_in6 address = raw(to);
  const ssize_t sent = ::sendto(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL,
                                reinterpret_cast<const sockaddr*>(&address), sizeof(address));
  return sent == static_cast<ssize_t>(bytes.size());
}

std::size_t UdpSocket::receive(std::span<std::uint8_t> bytes, UdpAddress& from,
                               Clock::time_point end) noexcept {
  if (socket_ < 0) return 0;
  for (;;) {
    sockaddr_in6 address{};
    socklen_t length = sizeof(address);
    const ssize_t got = ::recvfrom(socket_, bytes.data(), bytes.size(), 0,
                                   reinterpret_cast<sockaddr*>(&address), &length);
    if (got > 0 && address.sin6_family == AF_INET6) {
      std::memcpy(from.host.data(), &address.sin6_addr, from.host.size());
      from.port = ntohs(address.sin6_port);
      from.scope = address.sin6_scope_id;
      return static_cast<std::size_t>(got);
    }
    // reading clears the error of an earlier datagram, so try again
    const auto left = std::chrono::duration_cast<std::chrono::nanoseconds>(end - Clock::now());
    if (left.count() <= 0) return 0;
    pollfd waits{socket_, POLLIN, 0};
    const timespec time{left.count() / 1'000'000'000, left.count() % 1'000'000'000};
    if (::ppoll(&waits, 1, &time, nullptr) < 0 && errno != EINTR) return 0;
  }
}

}  // namespace prostm
