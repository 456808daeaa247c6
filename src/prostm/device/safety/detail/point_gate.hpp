#pragma once
/// Silences focal points where they come too close.

#include <cstdint>
#include <span>
#include <vector>

#include "prostm/emit/focus_sample.hpp"

namespace prostm {

/// Where sounding focal points come closer than a least separation, only the strongest of them goes
/// on sounding; a sample that is not finite is silent. Around such samples the point fades out and
/// in again: the gate looks ahead by the time of a fade, and samples leave that much later.
/// Positions never change. An intensity changes by at most its own change and a step of the fade.
/// Points of intensity 0 may lie anywhere.
class PointGate {
 public:
  struct Bounds {
    double least_separation = 0.0;  ///< of two sounding points [m]; 0 or less: any
    int fade = 1;                   ///< samples of a fade over the full range, >= 1
  };

  /// Forgets all samples. Allocates.
  void configure(int foci, const Bounds& bounds);
  /// Samples from one that is given to step() to the same one leaving it: the fade's.
  int delay() const { return delay_; }
  /// Takes a sample and gives the one that came delay() samples before, silent at first; `in` and
  /// `out` hold one sample each and may be the same.
  void step(std::span<const FocusSample> in, std::span<FocusSample> out) noexcept;
  /// Samples of a focal point that were silenced or weakened, since configure().
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
