#include <algorithm>
#include <cmath>

#include "prostm/acoustics/skin/skin_percept.hpp"
#include "prostm/core/units.hpp"
#include "prostm/score/felt.hpp"

namespace prostm {
namespace {

/// e of one harmonic at a cell, (S7) [m²].
double felt_of(const SkinMotion& motion, int n, std::size_t cell) {
  const double s = pacinian_sensitivity(motion.frequency(n));
  return 0.5 * s * s * std::norm(motion.displacement(n)[cell]);
}

/// Returns the cell where the sum of the harmonics for which `counts` is true is largest.
template <class Counts>
std::size_t strongest_of(const TargetField& raster, const SkinMotion& motion, bool skin_only,
                         Counts counts) {
  std::size_t strongest = 0;
  double largest = -1.0;
  for (std::size_t c = 0; c < raster.size(); ++c) {
    if (skin_only && raster.skin[c] == 0) continue;
    double sum = 0.0;
    for (int n = 1; n <= motion.harmonics(); ++n) {
      if (counts(motion.frequency(n))) sum += felt_of(motion, n, c);
    }
    if (sum > largest) strongest = c;
    largest = std::max(largest, sum);
  }
  return strongest;
}

}  // namespace

std::vector<FeltHarmonic> felt_spectrum(const TargetField& raster, const SkinMotion& motion) {
  const auto all = [](double) { return true; };
  const auto local = [](double frequency) { return frequency < kAreaSumsFrom; };
  const std::size_t strongest = strongest_of(raster, motion, true, all);
  const std::size_t strongest_local = strongest_of(raster, motion, false, local);
  const double area = raster.cell * raster.cell / kPerceptArea;
  std::vector<FeltHarmonic> out;
  double at_strongest = 0.0, intensity = 0.0;
  for (int n = 1; n <= motion.harmonics(); ++n) {
    FeltHarmonic harmonic;
    harmonic.frequency = motion.frequency(n);
    const double omega = 2.0 * kPi * harmonic.frequency;
    const auto field = motion.displacement(n);
    double cells = 0.0, square = 0.0, whole = 0.0;
    for (std::size_t c = 0; c < raster.size(); ++c) {
      whole += felt_of(motion, n, c);
      if (raster.skin[c] == 0) continue;
      cells += 1.0;
      square += 0.5 * std::norm(field[c]);
    }
    harmonic.share_at_strongest = felt_of(motion, n, strongest);
    harmonic.share_of_intensity =
        local(harmonic.frequency) ? felt_of(motion, n, strongest_local) : whole * area;
    harmonic.displacement_strongest = std::sqrt(0.5 * std::norm(field[strongest]));
    harmonic.displacement_skin = std::sqrt(square / cells);
    harmonic.velocity_strongest = omega * harmonic.displacement_strongest;
    harmonic.velocity_skin = omega * harmonic.displacement_skin;
    at_strongest += harmonic.share_at_strongest;
    intensity += harmonic.share_of_intensity;
    out.push_back(harmonic);
  }
  for (FeltHarmonic& harmonic : out) {
    if (at_strongest > 0.0) harmonic.share_at_strongest /= at_strongest;
    if (intensity > 0.0) harmonic.share_of_intensity /= intensity;
  }
  return out;
}

}  // namespace prostm
