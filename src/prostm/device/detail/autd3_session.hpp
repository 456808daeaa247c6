#pragma once
/// A conversation with AUTD3 units behind a server of v38's remote protocol.

#include <chrono>
#include <string>
#include <vector>

#include "prostm/device/detail/autd3_frames.hpp"
#include "prostm/device/detail/tcp_connection.hpp"

namespace prostm::autd3 {

/// Sends a frame to every unit and waits until all have acknowledged it; one frame is under way at
/// a time. After a failure, problem() says why in one sentence, and only open() helps.
class Session {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param units poses X_DU of the units' frames.
  Session(TcpAddress address, std::vector<Pose> units);

  /// Connects, tells where the units are, silences them, reads their firmware's versions, and
  /// measures how long a frame takes. @return false if anything of it failed.
  bool open();
  /// Says goodbye.
  void close() noexcept;

  std::size_t units() const { return frames_.size(); }
  /// The frame of a unit, for the next exchange.
  Frame& frame(std::size_t unit) { return frames_[unit]; }
  /// Copies the first unit's frame to the others.
  void same_for_all();
  /// Sends the frames. @return false if a unit refused them or did not answer in time.
  bool exchange() noexcept;
  /// Asks for the units' answers without a new frame. @return false if there is none.
  bool poll() noexcept;
  /// Segment of focal points that all units play, or −1 while they differ.
  int playing_segment() const;
  bool is_hot() const;  ///< whether a unit's temperature is too high

  double frames_per_ms() const { return frames_per_ms_; }
  bool is_open() const { return connection_.is_open(); }
  const std::string& problem() const { return problem_; }
  /// Versions of the first unit's firmware, as "CPU v12.1, FPGA v12.1".
  const std::string& firmware() const { return firmware_; }

  static constexpr std::chrono::milliseconds kPatience{200};  ///< for an answer
  static constexpr std::chrono::microseconds kPolls{200};     ///< between polls

 private:
  bool greet();
  bool tell_geometry();
  bool read_firmware();
  bool measure();
  bool request(std::span<const std::uint8_t> bytes);
  bool accepted(const char* what);
  bool fail(std::string sentence);
  bool lost();

  const TcpAddress address_;
  const std::vector<Pose> units_;
  TcpConnection connection_;
  std::vector<Frame> frames_;
  std::vector<Answer> answers_;
  std::vector<std::uint8_t> out_, in_;
  int message_ = 0;
  double frames_per_ms_ = 0.0;
  std::string problem_, firmware_;
};

}  // namespace prostm::autd3
