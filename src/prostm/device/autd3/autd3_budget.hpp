#pragma once
/// Samples that a link to AUTD3 units carries.

#include <vector>

namespace prostm {

/// Samples of a number of slots (foci of FociSTM), in blocks. A weighted focal point takes two
/// slots, one of several with a common intensity takes one.
struct Autd3Budget {
  int slots = 8;
  int divider = 6;  ///< periods of 40 kHz per sample
  int block_samples = 0;
  int block_frames = 0;        ///< that hold them
  double block_time = 0.0;     ///< [s]
  double frames_per_ms = 0.0;  ///< that the link takes
  /// Share of the link that blocks take, with the frame that keeps each audible.
  double load = 0.0;
  /// Share of the time that there is to write a block: from the answer that tells that the segment
  /// is free until the block before it begins to fall silent.
  double urgency = 0.0;

  double sample_rate() const;  ///< [Hz]
  double step() const;         ///< between samples of a focal point at 7 m/s [m]
};

inline constexpr double kAutd3DrawSpeed = 7.0;                              ///< [m/s]
inline constexpr double kAutd3ShortBlock = 10e-3, kAutd3LongBlock = 20e-3;  ///< [s]

/// Frames that hold a segment: whole samples, up to 74 slots in the first, 77 in each of the
/// others.
int autd3_frames(int slots, int samples);

/// Returns the budget of samples in blocks of about this time [s].
/// @param slow_frame time that a slow frame takes [s]; 0: that of any.
Autd3Budget autd3_budget(int slots, int divider, double block_time, double frames_per_ms,
                         double slow_frame = 0.0);

/// Returns the budget with the highest sampling rate, up to 10 kHz, whose blocks are written in
/// time, in the shorter blocks if these allow it.
/// @param block_time [s]; 0: 10 ms or 20 ms.
/// @throws std::invalid_argument if the link is too slow for 2 kHz.
Autd3Budget best_autd3_budget(int slots, double frames_per_ms, double slow_frame = 0.0,
                              double block_time = 0.0);

/// A table of budgets: slots × dividers × blocks × three numbers of frames per ms. The last index
/// is the fastest.
std::vector<Autd3Budget> autd3_budgets();

}  // namespace prostm
