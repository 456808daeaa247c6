#pragma once
/// Strength of a percept relative to the threshold of touch, (S20) to (S22) of docs/design/skin.md.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "prostm/acoustics/array/array.hpp"
#include "prostm/core/text/names.hpp"

namespace prostm {

/// Percept at the threshold of touch: the strongest √e, (S7), of a square wave of 0.4 mN at 200 Hz
/// on 1.8 cm² [m], the lowest force that is felt [S-9].
inline constexpr double kTouchThreshold = 3.63e-8;
/// Standard deviation of thresholds between people [dB]; assumed, not fitted.
inline constexpr double kThresholdSpread = 4.0;

/// Returns the radiation pressure of an array at its measured amplitude over that at its nominal
/// amplitude, (S20); 1 if none was measured.
double measured_share(const TransducerArray& array);

/// Returns the sensation level [dB] of a percept, (S21): its strongest √e relative to
/// kTouchThreshold, at the measured amplitude of the array. NaN for a percept that is NaN or not
/// above 0. @param percept strongest √e at the nominal amplitude [m].
double sensation_level(double percept, const TransducerArray& array);
/// The same for a percept at a known sound pressure.
double sensation_level(double percept);

/// Source of the sound pressure for which a sensation level holds.
enum class SoundSource : std::uint8_t {
  Nominal,   ///< nominal amplitude of the array
  Measured,  ///< measured amplitude of the array
  Given      ///< pressure that was given
};
template <>
inline constexpr std::array<std::string_view, 3> kNames<SoundSource> = {"nominal", "measured",
                                                                        "given"};

/// Distances from a sensation level to the ends of its interval of 95 % over people and arrays
/// [dB], (S22).
struct SensationInterval {
  double below = 0.0, above = 0.0;
  SoundSource sound = SoundSource::Given;
};
SensationInterval sensation_interval(const TransducerArray& array);
/// The interval at a given sound pressure: over people alone.
SensationInterval sensation_interval();

/// Returns a sensation level with its interval, and what it means, e.g. "about 3 dB above the
/// threshold of touch (-6 to 12 dB): most people feel it, some may not". @pre the level is finite
std::string sensation_words(double level, const SensationInterval& interval);

}  // namespace prostm
