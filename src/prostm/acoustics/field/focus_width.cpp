#include "prostm/acoustics/field/focus_width.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "prostm/acoustics/field/loop_field.hpp"
#include "prostm/acoustics/field/propagation.hpp"

namespace prostm {
namespace {

constexpr double kReach = 20e-3, kStep = 0.25e-3;  // half length and step of the lines [m]
constexpr double kLowest = 0.1;  // points below this share of the focus's pressure are not fitted

Eigen::VectorXcf focusing_drives(const PackedArray& packed, const Medium& medium,
                                 const Vec3& focus) {
  std::vector<double> phases(packed.transducers());
  focus_phases(packed.array, medium, focus, phases);
  Eigen::VectorXcf drives(static_cast<Eigen::Index>(phases.size()));
  for (std::size_t n = 0; n < phases.size(); ++n) {
    drives[static_cast<Eigen::Index>(n)] = std::complex<float>(std::polar(1.0, phases[n]));
  }
  return drives;
}

/// Returns σ of the main lobe along a line through the focus. Fits ln(P₀/P) = s²/2σ² with each
/// point weighted by P², so that errors are weighted as in a fit of P itself.
double fitted_width(const PackedArray& packed, const Medium& medium, const Eigen::VectorXcf& drives,
                    const Vec3& focus, const Vec3& normal, const Vec3& direction, double level) {
  SurfacePoints line;
  std::vector<double> place;
  for (double s = -kReach; s <= kReach; s += kStep) {
    place.push_back(s);
    line.p_D.push_back(focus + s * direction);
    line.normal.push_back(normal);
  }
  const std::vector<float> pressure = radiation_pressure(packed, medium, line, drives);
  const auto middle = static_cast<std::ptrdiff_t>(place.size() / 2);
  double both = 0.0, square = 0.0;
  for (const std::ptrdiff_t step : {-1, 1}) {
    // outwards until the lobe ends
    for (std::ptrdiff_t i = middle; i >= 0 && i < std::ssize(place); i += step) {
      const double p = static_cast<double>(pressure[static_cast<std::size_t>(i)]) / level;
      if (p < kLowest) break;
      const double s = place[static_cast<std::size_t>(i)], u = 0.5 * s * s;
      both += p * p * u * -std::log(p);
      square += p * p * u * u;
    }
  }
  return std::sqrt(square / std::max(both, 1e-300));
}

}  // namespace

double FocusWidth::sigma() const {
  return std::sqrt(along * across);
}

FocusWidth focus_width(const PackedArray& packed, const Medium& medium, const Vec3& focus,
                       const Vec3& normal, const Vec3& x) {
  propagation_to(packed.array, medium, std::span(&focus, 1));  // throws if the focus is invalid
  const Eigen::VectorXcf drives = focusing_drives(packed, medium, focus);
  FocusWidth out;
  out.level =
      static_cast<double>(radiation_pressure(packed, medium, {{focus}, {normal}}, drives).front());
  if (out.level <= 0.0) {
    throw std::invalid_argument("the surface at a focus faces away from the whole array");
  }
  out.along = fitted_width(packed, medium, drives, focus, normal, x, out.level);
  out.across = fitted_width(packed, medium, drives, focus, normal, normal.cross(x), out.level);
  return out;
}

std::vector<FocusWidthEntry> focus_width_table(const PackedArray& packed, const Medium& medium,
                                               std::span<const double> heights,
                                               std::span<const double> offsets,
                                               std::span<const double> tilts) {
  std::vector<FocusWidthEntry> table;
  for (const double height : heights) {
    for (const double offset : offsets) {
      for (const double tilt : tilts) {
        const Vec3 normal(std::sin(tilt), 0.0, -std::cos(tilt));
        const Vec3 along(std::cos(tilt), 0.0, std::sin(tilt));
        table.push_back({height, offset, tilt,
                         focus_width(packed, medium, Vec3(offset, 0.0, height), normal, along)});
      }
    }
  }
  return table;
}

}  // namespace prostm
