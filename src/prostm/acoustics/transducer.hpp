#pragma once
/// How transducers follow their drives in time.

#include <complex>
#include <span>
#include <vector>

namespace prostm {

/// One resonance, near the carrier.
struct TransducerSettings {
  double frequency = 40e3;    ///< carrier [Hz]
  double quality = 28.6;      ///< Q of the resonance
  double detuning = 0.0;      ///< resonance − carrier [Hz]
  double sample_rate = 40e3;  ///< at which drives change [Hz]
  bool memoryless = false;    ///< the output is the drive, at once
};

/// Time constant τ = Q/(πf) of the envelope [s], (A9): 0.228 ms for the defaults.
double time_constant(const TransducerSettings& settings);

/// The complex envelopes a of transducers' outputs for drives q that are constant over each sample:
/// τ da/dt = q − (1 + 2πiδτ) a, (A9), solved exactly, (A10). A drive of 1 held at resonance gives
/// an output of 1; phases are those of (A1), where e^{ikr} is a delay.
class TransducerDynamics {
 public:
  /// All silent.
  /// @throws std::invalid_argument with a sentence: frequency not in 20 to 100 kHz, quality not in
  /// 0.5 to 1000, |detuning| above a tenth of the frequency, sample_rate not in 1 kHz to 10 MHz.
  TransducerDynamics(const TransducerSettings& settings, std::size_t transducers);

  /// One sample with these drives, one for each transducer, |q| ≤ 1. Allocates nothing.
  /// @pre drives.size() == output().size()
  void step(std::span<const std::complex<double>> drives);
  /// The envelopes at the end of the last sample; they take the place of q in (A1).
  std::span<const std::complex<double>> output() const { return output_; }
  /// All silent again.
  void reset();

 private:
  std::complex<double> gain_;   ///< what a steady drive is multiplied by in the end
  std::complex<double> decay_;  ///< of what is left to go, per sample
  std::vector<std::complex<double>> output_;
};

}  // namespace prostm
