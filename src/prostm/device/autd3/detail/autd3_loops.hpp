#pragma once
/// Closed loops that AUTD3 units repeat.

#include <condition_variable>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>

#include "prostm/device/autd3/autd3_budget.hpp"
#include "prostm/device/autd3/detail/autd3_output.hpp"
#include "prostm/emit/focus_sample.hpp"

namespace prostm::autd3 {

/// A loop, and its encoding for the units.
struct Loop {
  std::vector<FocusSample> samples;  // sample-major
  int foci = 0;
  std::vector<std::vector<SlotWord>> words;  // of each unit, for the whole loop
  int length() const { return foci > 0 ? static_cast<int>(samples.size()) / foci : 0; }
};

/// Returns a sentence that says why a loop cannot be played; empty if it can.
std::string loop_problem(std::span<const FocusSample> samples, int foci, int most_foci, int slots);

/// Whether one loop can replace another at any sample: each audible focal point then moves by at
/// most `step` [m].
bool is_near(const Loop& from, const Loop& to, double step);

/// Plays a loop in one segment while the next loop is written to the other. It is kept audible for
/// 60 ms at a time. A new loop starts at once: at the current sample if it has the same length and
/// is near, otherwise in a short silence. begin() and play() return false if the session failed.
class Loops {
 public:
  Loops(Session& session, Output& output) : session_(session), output_(output) {}

  /// Sets the next loop. Any thread.
  void load(Loop loop);
  /// Discards all loops. @pre nothing is playing.
  void forget();
  /// @param step largest step of a focal point from sample to sample [m].
  bool begin(double step);
  /// Waits briefly, then loads a new loop and renews the current one if they are due.
  bool play(const std::stop_token& stop);

  /// Time for which a loop stays audible after its last renewal [s].
  static constexpr double kAudibleTime = 60e-3;

 private:
  bool take(Loop loop);
  bool keep_audible();

  Session& session_;
  Output& output_;
  double step_ = 0.0;
  Loop playing_;
  int segment_ = 0;
  Session::Clock::time_point renewed_{};

  std::mutex mutex_;  // guards next_
  std::condition_variable_any loaded_;
  std::optional<Loop> next_;
};

}  // namespace prostm::autd3
