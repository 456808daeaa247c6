#pragma once
/// A segment as an endless stream.

#include <mutex>
#include <string>
#include <vector>

#include "prostm/emit/focus_sample.hpp"

namespace prostm {

/// Says in one sentence what is wrong with a segment; empty if nothing is.
std::string segment_problem(std::span<const FocusSample> samples, int foci, int max_foci);

/// Repeats a segment. A new one takes over at the end of the one that plays, so that laps stay
/// whole.
class SegmentPlayer final : public SampleSource {
 public:
  /// Forgets what was loaded; the next segment has `foci` focal points a sample. @pre nothing
  /// pulls.
  void reset(int foci);
  /// Loads samples, sample-major, to play from the next end on. Any thread. @pre not empty, whole
  /// samples.
  void load(std::span<const FocusSample> samples);

  int foci() const override { return foci_; }
  void fill(std::int64_t first, std::span<FocusSample> out) noexcept override;

 private:
  void take_next() noexcept;

  int foci_ = 1;
  std::vector<FocusSample> playing_;  // of the thread that pulls
  std::size_t at_ = 0;                // in playing_
  std::mutex mutex_;                  // guards the members below
  std::vector<FocusSample> next_;
  bool has_next_ = false;
};

}  // namespace prostm
