#pragma once
/// Strength of a percept relative to the threshold of touch, (S20) to (S22) of docs/design/skin.md.

#include <string>

#include "prostm/acoustics/array/array.hpp"

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

/// Distances from a sensation level to the ends of its interval of 95 % over people and arrays
/// [dB], (S22).
struct SensationInterval {
  double below = 0.0, above = 0.0;
};
SensationInterval sensation_interval(const TransducerArray& array);

/// Returns a sensation level with its interval, and what it means, e.g. "about 3 dB above the
/// threshold of touch (-7 to 13 dB): most people feel it, some may not". @pre the level is finite
std::string sensation_words(double level, const TransducerArray& array);

}  // namespace prostm
