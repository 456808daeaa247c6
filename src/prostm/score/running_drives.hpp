#pragma once
/// Drives of an array for a continuous stream of focal points, across changes of the plan.

#include <cstdint>
#include <span>

#include "prostm/acoustics/array/array.hpp"
#include "prostm/score/detail/sample_solver.hpp"
#include "prostm/score/loop_drives.hpp"

namespace prostm {

/// Solves block after block of samples like loop_drives() solves a loop. Phases of focal points and
/// the state of the transducers carry over from block to block; the initial state is silence.
class RunningDrives {
 public:
  /// @param array, medium must outlive this. @param settings must contain a full scale, since later
  /// samples are not known in advance; samples that do not reach it are weaker.
  /// @throws std::invalid_argument as TransducerDynamics does, and for a full scale that is not
  /// above 0, or above 1e6 Pa, or foci not in 1 to 8.
  RunningDrives(const TransducerArray& array, const Medium& medium,
                const LoopDriveSettings& settings, int foci, double sample_rate);

  /// Computes the outputs of the transducers for the next samples.
  /// @param samples sample-major, [k·foci + f]. @param out transducers × samples
  /// @throws std::invalid_argument as propagation_to() and solve_foci() do.
  void next(std::span<const FocusSample> samples, LoopDrives& out);

  /// Number of samples so far that did not reach full scale.
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
