#include "prostm/device/stream/detail/stream_sockets.hpp"

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>

namespace prostm::stream {
namespace {

constexpr int kBacklog = 16;
constexpr int kSendBuffer = 64 << 10;  // of a TCP connection; small, since queued data grows stale
constexpr int kDatagramBuffer = 1 << 20;  // of all UDP subscribers
constexpr int kTries = 16;                // to find a port that is free for both TCP and UDP

std::invalid_argument refused(const HostPort& address, const std::string& why) {
  return std::invalid_argument("device stream://" + address.text() + " " + why);
}

Descriptor open_socket(const HostPort& address, std::uint16_t port, int type) {
  addrinfo hints{};
  hints.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV | AI_PASSIVE;
  hints.ai_socktype = type;
  const std::string host = address.host == "localhost" ? "127.0.0.1" : address.host;
  addrinfo* list = nullptr;
  if (getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &list) != 0) {
    throw refused(address,
                  "names no address of this machine: it must be a number, for example "
                  "127.0.0.1 for programs on this machine, or 0.0.0.0 for any network");
  }
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> owner(list, freeaddrinfo);
  Descriptor fd(::socket(list->ai_family, list->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const int yes = 1;
  // allow a port that the last run has just released
  if (type == SOCK_STREAM) setsockopt(fd.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
  if (type == SOCK_DGRAM)
    setsockopt(fd.get(), SOL_SOCKET, SO_SNDBUF, &kDatagramBuffer, sizeof(kDatagramBuffer));
  if (!fd || bind(fd.get(), list->ai_addr, list->ai_addrlen) != 0) {
    const int error = errno;
    if (error == EADDRINUSE) return {};
    const bool is_foreign = error == EADDRNOTAVAIL;
    throw refused(address, is_foreign
                               ? "names no address of this machine: see the list of `ip addr`"
                               : std::string("cannot be opened: ") + std::strerror(error));
  }
  if (type == SOCK_STREAM && listen(fd.get(), kBacklog) != 0) return {};
  return fd;
}

std::uint16_t port_of(const Descriptor& fd) {
  sockaddr_storage name{};
  socklen_t size = sizeof(name);
  getsockname(fd.get(), reinterpret_cast<sockaddr*>(&name), &size);
  // the port is at the same place for IPv4 and IPv6
  return ntohs(reinterpret_cast<const sockaddr_in*>(&name)->sin_port);
}

std::uint64_t mix(std::uint64_t state, std::uint64_t value) {
  state = (state ^ value) + 0x9E3779B97F4A7C15U;
  state = (state ^ (state >> 30U)) * 0xBF58476D1CE4E5B9U;
  state = (state ^ (state >> 27U)) * 0x94D049BB133111EBU;
  return state ^ (state >> 31U);
}

}  // namespace

void Descriptor::close() {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
}

std::uint64_t Address::mixed(std::uint64_t seed) const {
  std::uint64_t state = mix(seed, storage.ss_family);
  if (storage.ss_family == AF_INET) {
    const auto& v4 = reinterpret_cast<const sockaddr_in&>(storage);
    return mix(mix(state, v4.sin_addr.s_addr), v4.sin_port);
  }
  const auto& v6 = reinterpret_cast<const sockaddr_in6&>(storage);
  for (const std::uint8_t byte : v6.sin6_addr.s6_addr) state = mix(state, byte);
  return mix(mix(state, v6.sin6_port), v6.sin6_scope_id);
}

bool Address::operator==(const Address& other) const {
  if (storage.ss_family != other.storage.ss_family) return false;
  if (storage.ss_family == AF_INET) {
    const auto& a = reinterpret_cast<const sockaddr_in&>(storage);
    const auto& b = reinterpret_cast<const sockaddr_in&>(other.storage);
    return a.sin_addr.s_addr == b.sin_addr.s_addr && a.sin_port == b.sin_port;
  }
  const auto& a = reinterpret_cast<const sockaddr_in6&>(storage);
  const auto& b = reinterpret_cast<const sockaddr_in6&>(other.storage);
  return std::memcmp(&a.sin6_addr, &b.sin6_addr, sizeof(a.sin6_addr)) == 0 &&
         a.sin6_port == b.sin6_port && a.sin6_scope_id == b.sin6_scope_id;
}

std::uint32_t Address::token(std::uint64_t secret) const {
  const auto token = static_cast<std::uint32_t>(mix(mixed(secret), secret));
  return token == 0 ? 1 : token;
}

Sockets open_sockets(const HostPort& address) {
  for (int i = 0; i < kTries; ++i) {
    Sockets sockets;
    sockets.tcp = open_socket(address, address.port, SOCK_STREAM);
    if (sockets.tcp) {
      sockets.port = port_of(sockets.tcp);
      sockets.udp = open_socket(address, sockets.port, SOCK_DGRAM);
    }
    if (sockets.udp) return sockets;
    if (address.port != 0) break;
  }
  throw refused(address,
                "cannot be opened: the port is in use by another program; name another port");
}

Descriptor accept_connection(const Descriptor& listening) {
  Descriptor fd(accept4(listening.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
  if (!fd) return fd;
  const int yes = 1;
  setsockopt(fd.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof(yes));
  setsockopt(fd.get(), SOL_SOCKET, SO_SNDBUF, &kSendBuffer, sizeof(kSendBuffer));
  return fd;
}

std::ptrdiff_t receive(const Descriptor& udp, std::span<std::uint8_t> into, Address& from) {
  from.size = sizeof(from.storage);
  return recvfrom(udp.get(), into.data(), into.size(), MSG_DONTWAIT | MSG_TRUNC,
                  reinterpret_cast<sockaddr*>(&from.storage), &from.size);
}

bool send_to(const Descriptor& udp, std::span<const std::uint8_t> bytes, const Address& to) {
  const auto sent = sendto(udp.get(), bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
                           reinterpret_cast<const sockaddr*>(&to.storage), to.size);
  // an unreachable receiver does not count as a full buffer: its subscription expires
  return sent >= 0 || (errno != EAGAIN && errno != EWOULDBLOCK && errno != ENOBUFS);
}

}  // namespace prostm::stream
