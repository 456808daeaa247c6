#pragma once
/// Times of a stream to AUTD3 units.

namespace prostm::autd3 {

inline constexpr double kCarrier = 40e3;  ///< [Hz], from which all sampling rates are divided
inline constexpr double kRamp = 1.5e-3;   ///< of a modulation that begins or ends [s]
inline constexpr double kSeen = 0.4e-3;   ///< after a turn, until an answer tells of it [s]
/// Samples of the modulation are no shorter than this, in periods of 40 kHz.
inline constexpr int kLeastModulationDivider = 10;

/// A modulation ends so long before its block does [s]: it begins when its frame arrives, which is
/// not known better than a frame's time [s].
inline double early(double frame_time) {
  constexpr double kMargin = 0.3e-3;
  return frame_time + kMargin;
}

}  // namespace prostm::autd3
