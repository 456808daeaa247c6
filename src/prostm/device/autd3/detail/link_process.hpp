#pragma once
/// A small process that holds the connection to AUTD3 units, and silences them when its owner ends.

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "prostm/device/autd3/detail/tcp_connection.hpp"

namespace prostm::autd3 {

/// Relays requests to a server of AUTD3's remote protocol and replies back to the owner, one whole
/// message at a time. The process is forked from the caller, ignores the signals that terminate
/// programs, and keeps no other file open. When the owner closes its end or terminates in any way,
/// the process waits for the pending reply, clears all units, sends Close to the server and exits,
/// within kPatience even if the server does not answer. It does the same when a request arrives
/// later than its owner allowed. When the server closes the connection, the process exits, which
/// closes the owner's end. Not thread-safe.
class LinkProcess {
 public:
  using Clock = std::chrono::steady_clock;
  using Duration = TcpConnection::Duration;
  static constexpr std::chrono::milliseconds kPatience{150};

  LinkProcess() = default;
  ~LinkProcess() { close(); }
  LinkProcess(const LinkProcess&) = delete;
  LinkProcess& operator=(const LinkProcess&) = delete;

  /// Connects and starts the process. @return the reason of a failure in a few words; empty on
  /// success.
  /// @param units number of units that the geometry will declare, 1..kMostUnits.
  std::string open(const HostPort& address, std::size_t units, Duration patience);
  /// Closes the owner's end, and waits until the process has exited.
  void close() noexcept;
  bool is_open() const { return pipe_.is_open(); }
  pid_t process() const { return process_; }  ///< 0: none

  /// Sends a whole request; false if that failed, as for TcpConnection::send().
  /// @param latest time after which the request must not reach the server.
  bool send(std::span<const std::uint8_t> bytes, Clock::time_point latest,
            Duration patience) noexcept;
  bool receive(std::span<std::uint8_t> bytes, Duration patience) noexcept {
    return pipe_.receive(bytes, patience);
  }

 private:
  TcpConnection pipe_;
  std::vector<std::uint8_t> message_;  // a time, and the request
  pid_t process_ = 0;
};

}  // namespace prostm::autd3
