#pragma once
/// Sound levels at the head of whoever sits at an array, and the published limits on them.

#include <array>
#include <span>

#include "prostm/acoustics/array/array.hpp"

namespace prostm {

/// Distances of the head from the array at which levels are reported [m].
inline constexpr std::array<double, 3> kHeadDistances = {0.3, 0.5, 1.0};

/// Sound levels at full drive, on the axis of the array [dB re 20 µPa rms]. docs/design/safety.md,
/// (G5).

struct HeadLevel {
  double distance = 0.0;  ///< of the head from the middle of the array [m]
  /// Smallest amplitude of the sources, incoherent sum of the transducers, no reflections.
  double low = 0.0;
  /// Largest amplitude, incoherent sum, plus the scattering of a hand at 200 mm: the power emitted
  /// within 45° of the transducers' axes, spread evenly over a half-space. The cap applies to this
  /// level.
  double estimate = 0.0;
  /// Largest amplitude, all transducers in phase, with a reflection of the same strength: an upper
  /// bound for any drives.
  double bound = 0.0;
};

/// @pre validate(array) passes; distance > 0 [m].
HeadLevel head_level(const TransducerArray& array, double distance);

/// A limit on airborne ultrasound in a third of an octave around 40 kHz.
struct ExposureLimit {
  const char* name;
  double level;        ///< [dB re 20 µPa]
  const char* source;  ///< source of the number, and whether it was checked
};
/// In increasing order.
std::span<const ExposureLimit> exposure_limits();

}  // namespace prostm
