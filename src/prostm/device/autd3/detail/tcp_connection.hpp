#pragma once
/// A TCP connection with a timeout on every call.

#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "prostm/core/text/host_port.hpp"

namespace prostm {

/// The client's end. Only open() allocates, and nothing throws. Not thread-safe.
class TcpConnection {
 public:
  using Duration = std::chrono::steady_clock::duration;

  TcpConnection() = default;
  /// Takes ownership of a connected, non-blocking stream socket.
  explicit TcpConnection(int socket) : socket_(socket) {}
  ~TcpConnection() { close(); }
  TcpConnection(const TcpConnection&) = delete;
  TcpConnection& operator=(const TcpConnection&) = delete;
  TcpConnection(TcpConnection&& other) noexcept : socket_(std::exchange(other.socket_, -1)) {}
  TcpConnection& operator=(TcpConnection&& other) noexcept {
    close();
    socket_ = std::exchange(other.socket_, -1);
    return *this;
  }

  /// Connects. @return the reason of a failure in a few words; empty on success.
  std::string open(const HostPort& address, Duration patience);
  void close() noexcept;
  bool is_open() const { return socket_ >= 0; }
  int socket() const { return socket_; }  ///< −1: not open

  /// Sends all bytes; false on a timeout or a lost connection, which is then unusable.
  bool send(std::span<const std::uint8_t> bytes, Duration patience) noexcept;
  /// Receives exactly as many bytes as fit; fails likewise.
  bool receive(std::span<std::uint8_t> bytes, Duration patience) noexcept;

 private:
  int socket_ = -1;
};

}  // namespace prostm
