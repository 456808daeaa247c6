#pragma once
/// Drives of an array that plays focal points which go on: plans that take over from one another.

#include <cstdint>
#include <span>

#include "prostm/acoustics/array/array.hpp"
#include "prostm/score/detail/sample_solver.hpp"
#include "prostm/score/loop_drives.hpp"

namespace prostm {

/// Solves stretch after stretch of samples as loop_drives() solves a loop. Phases of focal points
/// and the state of the transducers go on from one stretch to the next; all begins in silence.
class RunningDrives {
 public:
  /// @param array, medium outlive this. @param settings their full scale must be given, since what
  /// comes later is not known: samples that do not reach it are weaker.
  /// @throws std::invalid_argument as TransducerDynamics does, and for a full scale that is not
  /// above 0, or above 1e6 Pa, or foci not in 1 to 8.
  RunningDrives(const TransducerArray& array, const Medium& medium,
                const LoopDriveSettings& settings, int foci, double sample_rate);

  /// Computes the outputs of the transducers for the next samples.
  /// @param samples sample-major, [k·foci + f]. @param out transducers × samples
  /// @throws std::invalid_argument as propagation_to() and solve_foci() do.
  void next(std::span<const FocusSample> samples, LoopDrives& out);

  /// Samples so far that did not reach full scale.
  std::int64_t short_samples() const { return short_samples_; }

 private:
  const TransducerArray& array_;
  double full_scale_;
  std::size_t foci_;
  SampleSolver solver_;
  TransducerDynamics dynamics_;
  std::int64_t short_samples_ = 0;
};

}  // namespace prostm
