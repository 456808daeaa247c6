#pragma once
/// Air at rest: the temperature decides the speed of sound and the density.

#include <cmath>

namespace prostm {

/// Dry air as an ideal gas. Equations (M1) and (M2) of docs/design.md.
struct Medium {
  double temperature = 293.15;  ///< [K]
  double pressure = 101325.0;   ///< static pressure [Pa]

  /// c = sqrt(κ R T / M) [m/s], 343.2 m/s at 20 °C.
  double speed_of_sound() const {
    return std::sqrt(kHeatRatio * kGasConstant * temperature / kMolarMass);
  }
  /// ρ = p M / (R T) [kg/m³], 1.204 kg/m³ at 20 °C.
  double density() const { return pressure * kMolarMass / (kGasConstant * temperature); }

  static constexpr double kHeatRatio = 1.4;
  static constexpr double kGasConstant = 8.314463;  ///< [J/(mol K)]
  static constexpr double kMolarMass = 28.9647e-3;  ///< [kg/mol]
};

}  // namespace prostm
