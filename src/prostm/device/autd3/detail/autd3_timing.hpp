#pragma once
/// Times of a stream to AUTD3 units.

namespace prostm::autd3 {

inline constexpr double kCarrier = 40e3;  ///< all sampling rates are fractions of it [Hz]
inline constexpr double kRamp = 1.5e-3;   ///< ramp at the beginning and end of a modulation [s]
inline constexpr double kSeen = 0.4e-3;   ///< delay from a turn to the answer that reports it [s]
/// Shortest sample of a modulation, in periods of 40 kHz.
inline constexpr int kLeastModulationDivider = 10;

/// Time by which a modulation ends before its block [s]: it begins when its frame arrives, which is
/// known only to within the duration of a frame [s].
inline double early(double frame_time) {
  constexpr double kMargin = 0.3e-3;
  return frame_time + kMargin;
}

}  // namespace prostm::autd3
