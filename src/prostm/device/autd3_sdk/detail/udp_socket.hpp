#pragma once
/// A UDP socket over IPv6 with a timeout on every wait.

#include <array>
#include <chrono>
#include <cstdint>
#include <span>
#include <string>

namespace prostm {

struct UdpAddress {
  std::array<std::uint8_t, 16> host{};  ///< IPv6, in network order
  std::uint16_t port = 0;
  std::uint32_t scope = 0;  ///< number of the interface, for link-local addresses

  /// Whether host and port are equal; the scope is ignored, since replies need not report it.
  bool same_end(const UdpAddress& other) const { return host == other.host && port == other.port; }
  bool is_multicast() const { return host[0] == 0xFF; }
};

/// The socket of a client. Only open() allocates, and nothing throws. Not thread-safe.
class UdpSocket {
 public:
  using Clock = std::chrono::steady_clock;

  UdpSocket() = default;
  ~UdpSocket() { close(); }
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;

  /// Binds to the address from which `peer` is reached: loopback for a peer on loopback, else the
  /// link-local address of the peer's interface. @return the reason of a failure in a few words;
  /// empty on success.
  std::string open(const UdpAddress& peer);
  void close() noexcept;
  bool is_open() const { return socket_ >= 0; }

  /// Sends a datagram without waiting; false if the system does not accept it.
  bool send(const UdpAddress& to, std::span<const std::uint8_t> bytes) noexcept;
  /// Waits for a datagram until `end`. @return its size, at most that of `bytes`; 0 if there was
  /// none.
  std::size_t receive(std::span<std::uint8_t> bytes, UdpAddress& from,
                      Clock::time_point end) noexcept;

 private:
  int socket_ = -1;
};

}  // namespace prostm
