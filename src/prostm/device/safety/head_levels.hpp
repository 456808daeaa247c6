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
  /// Smallest amplitude of the sources, incoherent sum of the transducers, no reflections, with
  /// air's absorption.
  double low = 0.0;
  /// As `estimate`, with likely_amplitude() and air's absorption.
  double likely = 0.0;
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

/// A limit on airborne ultrasound in the third of an octave around 40 kHz.
struct ExposureLimit {
  double level;        ///< [dB re 20 µPa]
  const char* name;    ///< who published it, and when
  const char* scope;   ///< for whom and for how long
  const char* source;  ///< where
};
/// In increasing order.
std::span<const ExposureLimit> exposure_limits();

/// A recommended cap on the level at the head, and its cost.
struct RecommendedLevel {
  const char* use;
  double cap = 0.0;         ///< [safety] head_level, as HeadLevel::estimate [dB]
  double level = 0.0;       ///< likely level at the head under the cap [dB]
  double protection = 0.0;  ///< attenuation of the hearing protection that it assumes [dB]
  double cost = 0.0;        ///< felt strength below full output [dB]
  const char* advice;
};
/// Returns the caps for a study, in which people wear hearing protection, and for a demonstration,
/// in which they do not: each so that the likely level at the ear is at most 110 dB, the consensus
/// of limits. Strength in dB falls twice as fast as the level, since the skin feels the square of
/// the sound pressure.
std::array<RecommendedLevel, 2> recommended_levels(const HeadLevel& head);

}  // namespace prostm
