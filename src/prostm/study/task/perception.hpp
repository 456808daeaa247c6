#pragma once
/// A simulated observer for tasks with levels, used in rehearsals.

#include <cstdint>

#include "prostm/core/random.hpp"
#include "prostm/study/protocol/protocol.hpp"
#include "prostm/study/task/psychometric.hpp"

namespace prostm {

/// Detects levels with the probability given by a psychometric function, on the protocol's scale.
/// It is not a model of touch, but its threshold is known.
class Perception {
 public:
  /// @pre the protocol has levels, and outlives this. @param threshold level half-way between the
  /// guess rate and the upper asymptote, in the setting's unit. @param guess the guess rate: share
  /// of answers for the level when guessing, 0..1.
  Perception(const LevelSettings& level, double threshold, double guess, std::uint64_t seed);

  /// Whether a level, in the setting's unit, is felt. Draws a random number.
  bool feels(double level);
  /// The perceived distance of a level above the threshold, with noise, as a share of the range.
  /// Draws a random number.
  double distance(double level);
  /// A random guess among 0 … n − 1.
  int guess(int n) { return random_.below(n); }

 private:
  const LevelSettings& level_;
  Psychometric felt_;
  double width_;  // of the range of levels, on the scale
  Random random_;
};

}  // namespace prostm
