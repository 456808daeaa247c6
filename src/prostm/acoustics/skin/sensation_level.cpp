#include "prostm/acoustics/skin/sensation_level.hpp"

#include <cmath>
#include <limits>

namespace prostm {
namespace {

constexpr double kThresholdError = 3.0;  // of the force at threshold, "about 0.4 mN" [dB]
constexpr double kMeasuredError = 4.0;   // of the radiation pressure from a measured level [dB]

/// Level difference of the radiation pressures at two amplitudes [dB].
double pressure_level(double amplitude, double reference) {
  return 40.0 * std::log10(amplitude / reference);
}

std::string whole(double decibels) {
  return std::to_string(std::lround(decibels));
}

const char* meaning(double level, const SensationInterval& interval) {
  if (level - interval.below >= 0.0) return "nearly everyone feels it";
  if (level >= 0.0) return "most people feel it, some may not";
  if (level + interval.above >= 0.0) return "most people do not feel it, some may";
  return "hardly anyone feels it";
}

}  // namespace

double measured_share(const TransducerArray& array) {
  if (array.measured_amplitude == 0.0) return 1.0;
  return std::pow(array.measured_amplitude / array.amplitude, 2);
}

double sensation_level(double percept) {
  if (std::isnan(percept) || percept <= 0.0) return std::numeric_limits<double>::quiet_NaN();
  return 20.0 * std::log10(percept / kTouchThreshold);
}

double sensation_level(double percept, const TransducerArray& array) {
  return sensation_level(measured_share(array) * percept);
}

SensationInterval sensation_interval() {
  const double error = std::hypot(kThresholdError, 1.96 * kThresholdSpread);
  return {error, error, SoundSource::Given};
}

SensationInterval sensation_interval(const TransducerArray& array) {
  const double others = sensation_interval().below;
  if (array.measured_amplitude > 0.0) {
    const double error = std::hypot(others, kMeasuredError);
    return {error, error, SoundSource::Measured};
  }
  return {std::hypot(others, pressure_level(array.amplitude, array.amplitude_low)),
          std::hypot(others, pressure_level(array.amplitude_high, array.amplitude)),
          SoundSource::Nominal};
}

std::string sensation_words(double level, const SensationInterval& interval) {
  return "about " + whole(std::abs(level)) + " dB " + (level < 0.0 ? "below" : "above") +
         " the threshold of touch (" + whole(level - interval.below) + " to " +
         whole(level + interval.above) + " dB): " + meaning(level, interval);
}

}  // namespace prostm
