#include "prostm/acoustics/array/transducer.hpp"

#include <algorithm>
#include <cmath>

#include "prostm/core/require.hpp"
#include "prostm/core/units.hpp"

namespace prostm {

double time_constant(const TransducerSettings& settings) {
  return settings.quality / (kPi * settings.frequency);
}

TransducerDynamics::TransducerDynamics(const TransducerSettings& settings, std::size_t transducers)
    : gain_(1.0), decay_(0.0), output_(transducers) {
  require_between("frequency", settings.frequency, 20e3, 100e3, "Hz");
  require_between("quality", settings.quality, 0.5, 1000.0);
  require_between("detuning", settings.detuning, -0.1 * settings.frequency,
                  0.1 * settings.frequency, "Hz");
  require_between("sample_rate", settings.sample_rate, 1e3, 10e6, "Hz");
  if (settings.memoryless) return;
  const double tau = time_constant(settings);
  const std::complex<double> pole(1.0, 2.0 * kPi * settings.detuning * tau);
  gain_ = 1.0 / pole;
  decay_ = std::exp(-pole / (tau * settings.sample_rate));
}

void TransducerDynamics::step(std::span<const std::complex<double>> drives) {
  // smaller remainders are set to 0; otherwise they would decay into slow subnormal numbers
  constexpr double kSilence = 1e-60;  // squared magnitude
  for (std::size_t i = 0; i < output_.size(); ++i) {
    const std::complex<double> end = gain_ * drives[i];
    const std::complex<double> left = decay_ * (output_[i] - end);
    output_[i] = std::norm(left) < kSilence ? end : end + left;
  }
}

void TransducerDynamics::reset() {
  std::fill(output_.begin(), output_.end(), 0.0);
}

}  // namespace prostm
