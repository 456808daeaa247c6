#pragma once
/// A model observer of levels, for rehearsals.

#include <cstdint>

#include "prostm/core/random.hpp"
#include "prostm/study/protocol/protocol.hpp"
#include "prostm/study/task/psychometric.hpp"

namespace prostm {

/// Feels levels as a psychometric function does, on the scale of the protocol. No model of touch,
/// but one with a known threshold.
class Perception {
 public:
  /// @pre the protocol has levels, and outlives this. @param threshold the level half-way between
  /// guessing and the most, in the setting's unit. @param guess share of answers for the level that
  /// guessing makes, 0..1.
  Perception(const LevelSettings& level, double threshold, double guess, std::uint64_t seed);

  /// Whether a level, in the setting's unit, is felt. Draws.
  bool feels(double level);
  /// The felt distance of a level above the threshold, with noise, as a share of the range. Draws.
  double distance(double level);
  /// A guess among 0 … n − 1. Draws.
  int guess(int n) { return random_.below(n); }

 private:
  const LevelSettings& level_;
  Psychometric felt_;
  double width_;  // of levels, on the scale
  Random random_;
};

}  // namespace prostm
