#include "prostm/acoustics/skin_percept.hpp"

#include <algorithm>
#include <cmath>

namespace prostm {
namespace {

/// ½ |s W|² of harmonic n at a cell [m²].
double felt(const SkinResponse& response, int n, std::size_t cell) {
  const double s = pacinian_sensitivity(response.frequency(n));
  return 0.5 * s * s * std::norm(response.displacement(n)[cell]);
}

}  // namespace

double pacinian_sensitivity(double frequency) {
  if (frequency > 300.0) return std::pow(300.0 / frequency, 1.5);
  const double octave = std::clamp(frequency, 40.0, 250.0) / 250.0;
  return octave * octave;
}

void percept_map(const SkinResponse& response, std::span<double> out) {
  for (std::size_t c = 0; c < out.size(); ++c) {
    double energy = 0.0;
    for (int n = 1; n <= response.harmonics(); ++n) energy += felt(response, n, c);
    out[c] = std::sqrt(energy);
  }
}

double perceived_intensity(const SkinResponse& response) {
  const SkinPatch& patch = response.patch();
  double summed = 0.0, strongest = 0.0;
  for (std::size_t c = 0; c < static_cast<std::size_t>(patch.rows * patch.cols); ++c) {
    double local = 0.0;
    for (int n = 1; n <= response.harmonics(); ++n) {
      (response.frequency(n) >= kAreaSumsFrom ? summed : local) += felt(response, n, c);
    }
    strongest = std::max(strongest, local);
  }
  return std::sqrt(summed * patch.cell * patch.cell / kPerceptArea + strongest);
}

}  // namespace prostm
