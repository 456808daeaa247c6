#pragma once
/// Dynamic response of transducers to their drives.

#include <complex>
#include <span>
#include <vector>

namespace prostm {

/// A transducer with one resonance, near the carrier.
struct TransducerSettings {
  double frequency = 40e3;    ///< carrier [Hz]
  double quality = 28.6;      ///< Q of the resonance
  double detuning = 0.0;      ///< resonance − carrier [Hz]
  double sample_rate = 40e3;  ///< rate of the drives [Hz]
  bool memoryless = false;    ///< whether the output follows the drive without delay
};

/// Time constant τ = Q/(πf) of the envelope [s], (A9): 0.228 ms for the defaults.
double time_constant(const TransducerSettings& settings);

/// The complex envelopes a of transducers' outputs for drives q that are constant over each sample:
/// τ da/dt = q − (1 + 2πiδτ) a, (A9), solved exactly, (A10). A drive of 1 held at resonance gives
/// an output of 1; phases are those of (A1), where e^{ikr} is a delay.
class TransducerDynamics {
 public:
  /// Starts silent.
  /// @throws std::invalid_argument for a frequency not in 20 to 100 kHz, quality not in 0.5 to
  /// 1000, |detuning| above a tenth of the frequency, sample_rate not in 1 kHz to 10 MHz.
  TransducerDynamics(const TransducerSettings& settings, std::size_t transducers);

  /// Advances by one sample with these drives, one per transducer, |q| ≤ 1. Allocates nothing.
  /// @pre drives.size() == output().size()
  void step(std::span<const std::complex<double>> drives);
  /// The envelopes at the end of the last sample; they replace q in (A1).
  std::span<const std::complex<double>> output() const { return output_; }
  /// Makes all transducers silent again.
  void reset();

 private:
  std::complex<double> gain_;   ///< steady output for a drive of 1
  std::complex<double> decay_;  ///< factor per sample of the remaining difference
  std::vector<std::complex<double>> output_;
};

}  // namespace prostm
