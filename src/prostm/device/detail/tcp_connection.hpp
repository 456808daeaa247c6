#pragma once
/// A TCP connection whose every wait has an end.

#include <chrono>
#include <cstdint>
#include <span>
#include <string>

namespace prostm {

/// HOST:PORT, where HOST is a name, an IPv4 address, or an IPv6 address in brackets.
struct TcpAddress {
  std::string host;
  int port = 0;
};

/// A client's end. Nothing but open() allocates, and nothing throws. Not for several threads.
class TcpConnection {
 public:
  using Duration = std::chrono::steady_clock::duration;

  TcpConnection() = default;
  ~TcpConnection() { close(); }
  TcpConnection(const TcpConnection&) = delete;
  TcpConnection& operator=(const TcpConnection&) = delete;

  /// Connects, or says in a few words why it cannot; empty if it could.
  std::string open(const TcpAddress& address, Duration patience);
  void close() noexcept;
  bool is_open() const { return socket_ >= 0; }

  /// Sends all bytes; false if that took longer than `patience` or the connection is lost. The
  /// connection is of no use then.
  bool send(std::span<const std::uint8_t> bytes, Duration patience) noexcept;
  /// Receives as many bytes as fit, likewise.
  bool receive(std::span<std::uint8_t> bytes, Duration patience) noexcept;

 private:
  int socket_ = -1;
};

}  // namespace prostm
