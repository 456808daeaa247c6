#include "prostm/acoustics/array/directivity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "prostm/core/units.hpp"

namespace prostm {
namespace {

/// (A8) at 0, 10, … 90°: the values of the data sheet that AUTD3's own field model uses.
constexpr std::array<double, 10> kSheet = {1.0,   1.0,   1.0,   0.891, 0.708,
                                           0.501, 0.355, 0.251, 0.200, 0.178};

/// Second derivatives, per square of a step, of the natural cubic spline through the values: the
/// solution of m_{i-1} + 4 m_i + m_{i+1} = 6 (y_{i-1} - 2 y_i + y_{i+1}) with 0 at both ends.
constexpr std::array<double, 10> spline_curvatures(const std::array<double, 10>& y) {
  std::array<double, 10> above{}, m{};
  for (std::size_t i = 1; i + 1 < y.size(); ++i) {
    const double pivot = 4.0 - above[i - 1];
    above[i] = 1.0 / pivot;
    m[i] = (6.0 * (y[i - 1] - 2.0 * y[i] + y[i + 1]) - m[i - 1]) / pivot;
  }
  for (std::size_t i = y.size() - 2; i > 0; --i) m[i] -= above[i] * m[i + 1];
  return m;
}

constexpr std::array<double, 10> kCurvature = spline_curvatures(kSheet);

double sheet_directivity(double cos_theta) {
  const double steps = std::acos(cos_theta) * (18.0 / kPi);
  const auto i = std::min(static_cast<std::size_t>(steps), kSheet.size() - 2);
  const double t = steps - static_cast<double>(i), s = 1.0 - t;
  return s * kSheet[i] + t * kSheet[i + 1] +
         ((s * s * s - s) * kCurvature[i] + (t * t * t - t) * kCurvature[i + 1]) / 6.0;
}

}  // namespace

const char* directivity_name(Directivity kind) {
  switch (kind) {
    case Directivity::Piston:
      return "piston";
    case Directivity::T4010A1:
      return "t4010a1";
    case Directivity::Omni:
      break;
  }
  return "omni";
}

double directivity(Directivity kind, double ka, double cos_theta) {
  if (kind == Directivity::Omni) return 1.0;
  if (cos_theta < 0.0) return 0.0;
  const double cosine = std::min(cos_theta, 1.0);
  if (kind == Directivity::T4010A1) return sheet_directivity(cosine);
  return piston_directivity(ka, std::sqrt((1.0 - cosine) * (1.0 + cosine)));
}

double piston_directivity(double ka, double sin_theta) {
  const double x = std::abs(ka * sin_theta);
  // the series 1 - x²/8 + x⁴/192 is exact to rounding here, and the quotient would be 0/0 on axis
  if (x < 1e-2) return 1.0 - x * x / 8.0 + x * x * x * x / 192.0;
  return 2.0 * std::cyl_bessel_j(1.0, x) / x;
}

}  // namespace prostm
