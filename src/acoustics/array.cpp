#include "acoustics/array.hpp"

#include <cmath>

#include "core/units.hpp"

namespace prostm {

TransducerArray usx_array() {
  constexpr int kSide = 16;
  constexpr double kPitch = 10.5e-3;  // [m]
  constexpr double kCentre = 0.5 * (kSide - 1);
  TransducerArray array;
  array.name = "usx";
  array.amplitude = 3.4;
  array.position.reserve(static_cast<std::size_t>(kSide) * kSide);
  for (int row = 0; row < kSide; ++row) {
    for (int col = 0; col < kSide; ++col) {
      array.position.emplace_back(kPitch * (col - kCentre), kPitch * (row - kCentre), 0.0);
    }
  }
  return array;
}

double wave_number(const TransducerArray& array, const Medium& medium) {
  return 2.0 * kPi * array.frequency / medium.speed_of_sound();
}

double piston_directivity(double ka, double sin_theta) {
  const double x = std::abs(ka * sin_theta);
  // the series 1 - x²/8 + x⁴/192 is exact to rounding here, and the quotient would be 0/0 on axis
  if (x < 1e-2) return 1.0 - x * x / 8.0 + x * x * x * x / 192.0;
  return 2.0 * std::cyl_bessel_j(1.0, x) / x;
}

std::complex<double> propagate(const TransducerArray& array, const Medium& medium, std::size_t i,
                               const Vec3& p) {
  const Vec3 d = p - array.position[i];
  const double r = d.norm();
  const double k = wave_number(array, medium);
  const double sin_theta = d.head<2>().norm() / r;
  return std::polar(1.0, k * r) *
         (array.amplitude * piston_directivity(k * array.radius, sin_theta) / r);
}

void focus_phases(const TransducerArray& array, const Medium& medium, const Vec3& focus,
                  std::span<double> out) {
  const double k = wave_number(array, medium);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = -k * (focus - array.position[i]).norm();
}

double radiation_pressure(double acoustic_pressure_rms, const Medium& medium) {
  const double c = medium.speed_of_sound();
  return 2.0 * acoustic_pressure_rms * acoustic_pressure_rms / (medium.density() * c * c);
}

}  // namespace prostm
