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

/// Passes requests to a server of AUTD3's remote protocol and its replies back, whole messages one
/// at a time. It is forked from the calling process, ignores the signals that end programs, and
/// keeps no other file open. When the owner closes its end, or ends in any way, it lets the reply
/// that is under way come in, makes all units forget what they play, says goodbye to the server,
/// and ends; if the server answers nothing, within kPatience. It does the same when a request comes
/// later than its owner allowed. When the server goes, it ends, and the owner's end is closed. Not
/// for several threads.
class LinkProcess {
 public:
  using Clock = std::chrono::steady_clock;
  using Duration = TcpConnection::Duration;
  static constexpr std::chrono::milliseconds kPatience{150};

  LinkProcess() = default;
  ~LinkProcess() { close(); }
  LinkProcess(const LinkProcess&) = delete;
  LinkProcess& operator=(const LinkProcess&) = delete;

  /// Connects and starts the process, or says in a few words why that failed; empty if it worked.
  /// @param units 1..kMostUnits, that will be told to the server.
  std::string open(const HostPort& address, std::size_t units, Duration patience);
  /// Closes the owner's end, and waits until the process has ended.
  void close() noexcept;
  bool is_open() const { return pipe_.is_open(); }
  pid_t process() const { return process_; }  ///< 0: none

  /// Sends a whole request; false if that failed, as of TcpConnection.
  /// @param latest after which it must not reach the server.
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
