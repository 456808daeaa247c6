#pragma once
/// Simulated output of an array that emits focal points: the solved drives, and the response of the
/// transducers.

#include <complex>
#include <span>
#include <vector>

#include "prostm/acoustics/array/transducer.hpp"
#include "prostm/acoustics/focus/live_focus_solver.hpp"

namespace prostm {

struct ArrayOutputSettings {
  LiveFocusSettings solver;
  TransducerSettings transducer;
};

/// Simulates one sample after another; allocates nothing after construction.
class ArrayOutput {
 public:
  /// Starts silent. @throws std::invalid_argument as LiveFocusSolver and TransducerDynamics do.
  ArrayOutput(const TransducerArray& array, const Medium& medium,
              const ArrayOutputSettings& settings);

  /// Advances by one sample.
  void step(std::span<const LiveFocus> foci) noexcept;

  /// Drives q of the last sample, |q| ≤ 1, one for each transducer.
  std::span<const std::complex<double>> drives() const { return drives_; }
  /// Envelopes of the transducers at the end of the last sample; they replace q in (A1).
  std::span<const std::complex<double>> envelopes() const { return transducers_.output(); }
  const LiveFocusSolver& solver() const { return solver_; }

  /// Resets the solver and silences the transducers.
  void reset();

 private:
  LiveFocusSolver solver_;
  TransducerDynamics transducers_;
  std::vector<std::complex<double>> drives_;
};

}  // namespace prostm
