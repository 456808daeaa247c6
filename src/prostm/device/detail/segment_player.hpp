#pragma once
/// Plays a segment as an endless stream.

#include <mutex>
#include <string>
#include <vector>

#include "prostm/emit/focus_sample.hpp"

namespace prostm {

/// Says in one sentence what is wrong with a segment; empty if nothing is.
std::string segment_problem(std::span<const FocusSample> samples, int foci, int max_foci);

/// Repeats a segment. A new segment starts when the current one reaches its end, so that every
/// repetition is complete.
class SegmentPlayer final : public SampleSource {
 public:
  /// Discards all segments; the next one has `foci` focal points per sample. @pre no thread is
  /// pulling.
  void reset(int foci);
  /// Loads samples, sample-major, which play once the current segment ends. Any thread. @pre not
  /// empty, whole samples.
  void load(std::span<const FocusSample> samples);

  /// The segment that is playing.
  struct Playing {
    std::int64_t number = 0;  ///< its number, counting loads since reset() from 1; 0: none yet
    std::int64_t first = 0;   ///< sample at which it began
  };
  Playing playing() const;

  int foci() const override { return foci_; }
  void fill(std::int64_t first, std::span<FocusSample> out) noexcept override;

 private:
  void take_next(std::int64_t first) noexcept;

  int foci_ = 1;
  std::vector<FocusSample> playing_;  // used by the pulling thread
  std::size_t at_ = 0;                // position in playing_
  mutable std::mutex mutex_;          // guards the members below
  std::vector<FocusSample> next_;
  bool has_next_ = false;
  std::int64_t loads_ = 0;
  Playing now_;
};

}  // namespace prostm
