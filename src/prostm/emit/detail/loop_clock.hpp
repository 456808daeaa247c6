#pragma once
/// The clock of the loop that all focal points of plans in step share.

#include <cstdint>

#include "prostm/emit/detail/focus_motion.hpp"

namespace prostm {

/// Counts samples since the loop began. It keeps counting across plans with the same loop length.
class LoopClock {
 public:
  bool runs() const { return base_ > 0; }
  /// Whether it counts a loop of this length, or none.
  bool fits(const InStep& loop) const { return !runs() || base_ == loop.base; }
  void stop() { base_ = 0; }
  /// Begins the loop so that its first sample is the next one; begin_last(): the last one.
  void begin_next(const InStep& loop) { begin(loop, -1); }
  void begin_last(const InStep& loop) { begin(loop, 0); }
  void tick() { ++last_; }
  std::int64_t last() const { return last_; }  ///< count of the last sample

 private:
  void begin(const InStep& loop, std::int64_t last) {
    base_ = loop.base;
    last_ = last;
  }
  std::int64_t base_ = 0, last_ = 0;
};

}  // namespace prostm
