#pragma once
/// A session with AUTD3 units behind a server of v38's remote protocol.

#include <chrono>
#include <string>
#include <vector>

#include "prostm/device/autd3/autd3_reply.hpp"
#include "prostm/device/autd3/detail/autd3_frames.hpp"
#include "prostm/device/autd3/detail/link_process.hpp"
#include "prostm/device/autd3/detail/turn_clock.hpp"

namespace prostm::autd3 {

/// Sends a frame to every unit and waits until all have acknowledged it; one frame is in flight at
/// a time. After a failure, problem() gives the reason in one sentence, and the session must be
/// opened again. A separate process holds the connection, see LinkProcess.
class Session {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param units poses X_DU of the units' frames, 1..kMostUnits.
  Session(HostPort address, std::vector<Pose> units);

  /// Connects, sends the poses of the units, and reads the versions of their firmware. @param
  /// patience longest time to wait for the server to open its bus. @return false if any step
  /// failed.
  bool open(Clock::duration patience);
  /// Clears the units, makes them report their state from now on, and passes to `turns` which
  /// segment they play.
  bool prepare(TurnClock* turns);
  /// Measures the duration of frames; has no other effect.
  bool measure();
  /// Fails with this clause, which follows the address in problem().
  bool give_up(const char* words) { return fail(words); }
  /// Sends Close and closes the connection.
  void close() noexcept;

  std::size_t units() const { return frames_.size(); }
  /// The frame of a unit, for the next exchange.
  Frame& frame(std::size_t unit) { return frames_[unit]; }
  /// Copies the first unit's frame to the others.
  void same_for_all();
  /// Sends the frames. @return false if the server did not take them in time.
  /// @param latest time after which the frames would do harm; the connection is cut instead.
  bool send(Clock::time_point latest = Clock::time_point::max()) noexcept;
  /// Waits until all units have acknowledged the frames. @return false if one refused or timed out.
  bool confirm() noexcept;
  /// Does both, with the first unit's frame for all units.
  bool exchange_for_all(Clock::time_point latest = Clock::time_point::max()) noexcept;
  /// Requests the units' answers without sending a frame. @return false if none arrive.
  bool poll() noexcept;

  int playing_segment()
      const;            ///< segment that all units play; −1 while they differ or do not report it
  bool is_hot() const;  ///< whether a unit reports that it is too hot

  double frames_per_ms() const { return 1e-3 / frame_time_; }
  double slow_frame() const { return slow_frame_; }  ///< time that one frame in ten exceeds [s]
  bool is_open() const { return link_.is_open(); }
  const std::string& problem() const { return problem_; }
  /// Versions of the first unit's firmware, as "CPU v12.1.0, FPGA v12.1.0".
  const std::string& firmware() const { return firmware_; }
  pid_t link_process() const { return link_.process(); }

  static constexpr std::chrono::milliseconds kPatience{200};  ///< for an answer
  static constexpr std::chrono::microseconds kPolls{200};     ///< between polls
  static constexpr std::chrono::seconds kOpenTime{10};        ///< opening a real bus takes seconds

 private:
  bool greet(Clock::duration patience);
  bool send_geometry(Clock::duration patience);
  bool read_firmware();
  bool ask(Request request, const char* what, Clock::duration patience,
           Clock::time_point latest = Clock::time_point::max());
  bool fail(const std::string& sentence);
  bool lost();

  const HostPort address_;
  const std::vector<Pose> units_;
  LinkProcess link_;
  std::vector<Frame> frames_;
  std::vector<Answer> answers_;
  std::vector<std::uint8_t> out_, in_;
  TurnClock* turns_ = nullptr;
  int message_ = 0;
  double frame_time_ = 1e-3, slow_frame_ = 1e-3;  // [s]
  std::string problem_, firmware_;
};

}  // namespace prostm::autd3
