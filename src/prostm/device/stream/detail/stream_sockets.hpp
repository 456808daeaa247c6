#pragma once
/// The sockets of a stream: one for TCP and one for UDP, on the same port number.

#include <sys/socket.h>

#include <cstdint>
#include <span>
#include <utility>

#include "prostm/core/text/host_port.hpp"

namespace prostm::stream {

/// Owns a file descriptor.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~Descriptor() { close(); }

  int get() const { return fd_; }
  explicit operator bool() const { return fd_ >= 0; }
  void close();

 private:
  int fd_ = -1;
};

/// A sender's address.
struct Address {
  sockaddr_storage storage{};
  socklen_t size = 0;

  bool operator==(const Address& other) const;
  /// A number for this address that only the owner of `secret` can compute; never 0.
  std::uint32_t token(std::uint64_t secret) const;

 private:
  /// Hash of the bytes that identify the address.
  std::uint64_t mixed(std::uint64_t seed) const;
};

struct Sockets {
  Descriptor tcp, udp;
  std::uint16_t port = 0;
};

/// Starts listening, without blocking. @param address of this machine, numeric, or localhost; port
/// 0: any that is free for both. @throws std::invalid_argument with a sentence.
Sockets open_sockets(const HostPort& address);

/// Accepts a connection, with TCP_NODELAY set; empty if none is pending.
Descriptor accept_connection(const Descriptor& listening);

/// Receives a datagram. Returns its size, which may exceed `into`; negative if nothing has arrived.
std::ptrdiff_t receive(const Descriptor& udp, std::span<std::uint8_t> into, Address& from);

/// Sends a datagram; false if the socket's buffer is full.
bool send_to(const Descriptor& udp, std::span<const std::uint8_t> bytes, const Address& to);

}  // namespace prostm::stream
