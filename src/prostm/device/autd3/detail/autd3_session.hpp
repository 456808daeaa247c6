#pragma once
/// A conversation with AUTD3 units behind a server of v38's remote protocol.

#include <chrono>
#include <string>
#include <vector>

#include "prostm/device/autd3/autd3_reply.hpp"
#include "prostm/device/autd3/detail/autd3_frames.hpp"
#include "prostm/device/autd3/detail/link_process.hpp"
#include "prostm/device/autd3/detail/turn_clock.hpp"

namespace prostm::autd3 {

/// Sends a frame to every unit and waits until all have acknowledged it; one frame is under way at
/// a time. After a failure, problem() says why in one sentence, and only open() helps. A process of
/// its own holds the connection, see LinkProcess.
class Session {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param units poses X_DU of the units' frames, 1..kMostUnits.
  Session(HostPort address, std::vector<Pose> units);

  /// Connects, tells where the units are, and reads the versions of their firmware. Waits that long
  /// at most for the server to open its bus. @return false if anything of it failed.
  bool open(Clock::duration patience);
  /// Silences the units, asks them to tell their state from now on, and lets `turns` see which
  /// segment they play.
  bool prepare(TurnClock* turns);
  /// Measures how long frames take, which changes nothing else.
  bool measure();
  /// Fails with these words, which follow the address.
  bool give_up(const char* words) { return fail(words); }
  /// Says goodbye.
  void close() noexcept;

  std::size_t units() const { return frames_.size(); }
  /// The frame of a unit, for the next exchange.
  Frame& frame(std::size_t unit) { return frames_[unit]; }
  /// Copies the first unit's frame to the others.
  void same_for_all();
  /// Sends the frames. @return false if the server did not take them in time.
  /// @param latest after which they would do harm; the connection is cut instead.
  bool send(Clock::time_point latest = Clock::time_point::max()) noexcept;
  /// Waits until all units have answered. @return false if one refused or did not in time.
  bool confirm() noexcept;
  /// Both, with the first unit's frame for all.
  bool exchange_for_all(Clock::time_point latest = Clock::time_point::max()) noexcept;
  /// Asks for the units' answers without a new frame. @return false if they do not come.
  bool poll() noexcept;

  int playing_segment()
      const;            ///< of focal points, by all units; −1 while they differ or do not tell
  bool is_hot() const;  ///< whether a unit says that its temperature is too high

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
  bool tell_geometry(Clock::duration patience);
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
