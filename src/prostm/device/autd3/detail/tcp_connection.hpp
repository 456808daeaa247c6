#pragma once
/// A TCP connection whose every wait has an end.

#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "prostm/core/text/host_port.hpp"

namespace prostm {

/// A client's end. Nothing but open() allocates, and nothing throws. Not for several threads.
class TcpConnection {
 public:
  using Duration = std::chrono::steady_clock::duration;

  TcpConnection() = default;
  /// Takes over a connected stream socket that does not block.
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

  /// Connects, or says in a few words why it cannot; empty if it could.
  std::string open(const HostPort& address, Duration patience);
  void close() noexcept;
  bool is_open() const { return socket_ >= 0; }
  int socket() const { return socket_; }  ///< −1: not open

  /// Sends all bytes; false if that took longer than `patience` or the connection is lost. The
  /// connection is of no use then.
  bool send(std::span<const std::uint8_t> bytes, Duration patience) noexcept;
  /// Receives as many bytes as fit, likewise.
  bool receive(std::span<std::uint8_t> bytes, Duration patience) noexcept;

 private:
  int socket_ = -1;
};

}  // namespace prostm
