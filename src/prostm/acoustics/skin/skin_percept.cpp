#include "prostm/acoustics/skin/skin_percept.hpp"

#include <algorithm>
#include <cmath>

namespace prostm {
namespace {

/// ½ |s W|² of harmonic n at a cell [m²].
double felt(const SkinMotion& motion, int n, std::size_t cell) {
  const double s = pacinian_sensitivity(motion.frequency(n));
  return 0.5 * s * s * std::norm(motion.displacement(n)[cell]);
}

}  // namespace

double pacinian_sensitivity(double frequency) {
  if (frequency > 300.0) return std::pow(300.0 / frequency, 1.5);
  const double octave = std::clamp(frequency, 40.0, 250.0) / 250.0;
  return octave * octave;
}

void percept_map(const SkinMotion& motion, std::span<double> out) {
  for (std::size_t c = 0; c < out.size(); ++c) {
    double energy = 0.0;
    for (int n = 1; n <= motion.harmonics(); ++n) energy += felt(motion, n, c);
    out[c] = std::sqrt(energy);
  }
}

double perceived_intensity(const SkinMotion& motion) {
  const SkinPatch& patch = motion.patch();
  double summed = 0.0, strongest = 0.0;
  for (std::size_t c = 0; c < static_cast<std::size_t>(patch.rows * patch.cols); ++c) {
    double local = 0.0;
    for (int n = 1; n <= motion.harmonics(); ++n) {
      (motion.frequency(n) >= kAreaSumsFrom ? summed : local) += felt(motion, n, c);
    }
    strongest = std::max(strongest, local);
  }
  return std::sqrt(summed * patch.cell * patch.cell / kPerceptArea + strongest);
}

}  // namespace prostm
