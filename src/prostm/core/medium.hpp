#pragma once
/// Air at rest: speed of sound, density, and absorption of sound.

#include <cmath>

namespace prostm {

/// An ideal gas; humidity changes only its absorption. Equations (M1) to (M5) of
/// docs/design/index.md.
struct Medium {
  double temperature = 293.15;  ///< [K]
  double pressure = 101325.0;   ///< static pressure [Pa]
  double humidity = 0.5;        ///< relative, 0..1

  /// c = sqrt(κ R T / M) [m/s], 343.2 m/s at 20 °C.
  double speed_of_sound() const {
    return std::sqrt(kHeatRatio * kGasConstant * temperature / kMolarMass);
  }
  /// ρ = p M / (R T) [kg/m³], 1.204 kg/m³ at 20 °C.
  double density() const { return pressure * kMolarMass / (kGasConstant * temperature); }

  /// Attenuation α of a pure tone [Np/m], amplitude falls as e^{−αr}: ISO 9613-1, (M3) to (M5);
  /// 0.152 Np/m at 40 kHz, 20 °C and a humidity of 50 %. @pre frequency > 0 [Hz].
  double absorption(double frequency) const;
  /// Attenuation in dB/m: α times 20 lg e = 8.686.
  double absorption_db(double frequency) const;

  static constexpr double kHeatRatio = 1.4;
  static constexpr double kGasConstant = 8.314463;  ///< [J/(mol K)]
  static constexpr double kMolarMass = 28.9647e-3;  ///< [kg/mol]
};

}  // namespace prostm
