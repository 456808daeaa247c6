#include "prostm/core/medium.hpp"

namespace prostm {

// The standard gives dB/m, with the rounded factor 8.686 before the sum; without the factor the sum
// is in Np/m.
double Medium::absorption(double frequency) const {
  constexpr double kReferenceTemperature = 293.15, kTriplePoint = 273.16;  // [K]
  constexpr double kReferencePressure = 101325.0;                          // [Pa]
  const double t = temperature / kReferenceTemperature;
  const double p = pressure / kReferencePressure;

  // (M3) molar concentration of water vapour [%]
  const double saturation =
      std::pow(10.0, 4.6151 - 6.8346 * std::pow(kTriplePoint / temperature, 1.261));
  const double h = 100.0 * humidity * saturation / p;

  // (M4) relaxation frequencies of oxygen and nitrogen [Hz]
  const double oxygen = p * (24.0 + 4.04e4 * h * (0.02 + h) / (0.391 + h));
  const double nitrogen =
      p / std::sqrt(t) * (9.0 + 280.0 * h * std::exp(-4.170 * (1.0 / std::cbrt(t) - 1.0)));

  // (M5) viscosity and heat conduction, then the two relaxations
  const double f2 = frequency * frequency;
  const double classical = 1.84e-11 * std::sqrt(t) / p;
  const double relaxing = 0.01275 * std::exp(-2239.1 / temperature) / (oxygen + f2 / oxygen) +
                          0.1068 * std::exp(-3352.0 / temperature) / (nitrogen + f2 / nitrogen);
  return f2 * (classical + relaxing / (t * t * std::sqrt(t)));
}

double Medium::absorption_db(double frequency) const {
  constexpr double kDecibelsPerNeper = 8.685889638065037;  // 20 lg e
  return kDecibelsPerNeper * absorption(frequency);
}

}  // namespace prostm
