#pragma once
/// Caps on the output to an array. They can be lowered, but not raised or switched off: the bounds
/// of the settings are the largest caps. docs/devices/safety.md gives the reasons.

#include "prostm/core/settings.hpp"

namespace prostm {

/// Levels assume the loudest array in the sources: every transducer has kLargestAmplitude, or the
/// array's own amplitude if that is larger.
struct SafetySettings {
  double intensity = 1.0;                  ///< of a focal point
  double power = 4.0;                      ///< Σ intensity² of a sample
  double acoustic_pressure = 14.6e3;       ///< rms, at a focal point [Pa]
  double radiation_pressure = 3e3;         ///< of a sample, at a focal point, on facing skin [Pa]
  double mean_radiation_pressure = 2.5e3;  ///< the same as a mean over any second [Pa]
  double head_level = 145.0;   ///< sound level at the head, mean over any second [dB re 20 µPa]
  double head_distance = 0.5;  ///< of the head from the array, 0.3 to 0.5 [m]

  void visit(SettingsReader& v) const;
  void visit(SettingsWriter& v);
  bool operator==(const SafetySettings&) const = default;
};

/// Smallest and largest rms acoustic pressure × distance, on axis at full drive, in the sources:
/// 2.53 to 8.02 Pa·m (docs/devices/safety.md).
inline constexpr double kSmallestAmplitude = 2.53, kLargestAmplitude = 8.02;

}  // namespace prostm
