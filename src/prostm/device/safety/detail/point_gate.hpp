#pragma once
/// Silences focal points that come too close to each other.

#include <cstdint>
#include <span>
#include <vector>

#include "prostm/emit/focus_sample.hpp"

namespace prostm {

/// Where active focal points come closer than a minimum separation, only the strongest of them
/// stays on. A sample that is not finite is silent. The point fades out before such samples and in
/// again after them: the gate looks ahead by the duration of a fade, and delays samples by as much.
/// Positions never change. An intensity changes by at most its own change plus a step of the fade.
/// Points of intensity 0 may be anywhere.
class PointGate {
 public:
  struct Bounds {
    double least_separation = 0.0;  ///< of two active points [m]; 0 or less: no limit
    int fade = 1;                   ///< samples of a fade over the full range, >= 1
  };

  /// Discards all samples. Allocates.
  void configure(int foci, const Bounds& bounds);
  /// Delay of step() in samples: the length of a fade.
  int delay() const { return delay_; }
  /// Takes a sample and returns the one taken delay() samples before; the first ones are silent.
  /// `in` and `out` hold one sample each and may be the same.
  void step(std::span<const FocusSample> in, std::span<FocusSample> out) noexcept;
  /// Samples of a focal point that were silenced or attenuated since configure().
  std::int64_t weakened() const { return weakened_; }

 private:
  struct Waiting {
    FocusSample sample;
    float gain = 1.0F;
  };
  Waiting& waiting(std::size_t focus, std::size_t back);
  void take(std::size_t focus, const FocusSample& given);
  void choose();
  void gate(std::size_t focus);

  std::size_t foci_ = 0, newest_ = 0;
  int delay_ = 1;
  float least_squared_ = 0.0F, fade_step_ = 1.0F;
  std::vector<Waiting> line_;           // delay_ + 1 samples, a ring
  std::vector<char> sounds_, refused_;  // of each focal point, for the newest sample
  std::vector<std::size_t> order_;      // focal points, the strongest first
  std::int64_t weakened_ = 0;
};

}  // namespace prostm
