#pragma once
/// Pressure on skin for the tests: a Gaussian focus on a circle.

#include <cmath>
#include <vector>

#include "prostm/acoustics/skin/skin_response.hpp"
#include "prostm/core/geometry.hpp"
#include "prostm/core/units.hpp"

namespace prostm::test {

/// A focus of 1 N, p ∝ e^{−r²/2σ²}, that circles the patch's middle.
struct CirclingFocus {
  double radius = 10e-3, sigma = 4e-3;  ///< [m]
  double period = 10e-3;                ///< [s]

  Vec2 at(double time) const {
    const double angle = 2.0 * kPi * time / period;
    return radius * Vec2(std::cos(angle), std::sin(angle));
  }
  double pressure(const Vec2& x, double time) const {
    return std::exp(-0.5 * (x - at(time)).squaredNorm() / (sigma * sigma)) /
           (2.0 * kPi * sigma * sigma);
  }
};

/// Returns the centre of cell (row, col) relative to the patch's middle [m].
inline Vec2 cell_centre(const SkinPatch& patch, int row, int col) {
  return patch.cell * Vec2(col - 0.5 * (patch.cols - 1), row - 0.5 * (patch.rows - 1));
}

inline std::vector<double> sampled(const CirclingFocus& focus, const SkinPatch& patch,
                                   int samples) {
  std::vector<double> pressure;
  for (int k = 0; k < samples; ++k) {
    for (int j = 0; j < patch.rows; ++j) {
      for (int i = 0; i < patch.cols; ++i) {
        pressure.push_back(focus.pressure(cell_centre(patch, j, i), k * focus.period / samples));
      }
    }
  }
  return pressure;
}

/// Computes the response to a focus on a circle, up to `highest` [Hz].
inline SkinResponse response_to(const CirclingFocus& focus, const SkinModel& skin,
                                const SkinPatch& patch, int samples, double highest = 1000.0) {
  SkinResponse response(skin, patch);
  response.prepare(focus.period, samples, highest);
  const std::vector<double> pressure = sampled(focus, patch, samples);
  response.respond({focus.period, samples, pressure});
  return response;
}

}  // namespace prostm::test
