#pragma once
/// Load that a stream of samples puts on the link to AUTD3 units.

#include <vector>

namespace prostm {

/// Blocks of samples with a number of slots each (foci of FociSTM). A focal point takes two slots
/// if it has its own intensity, and one if the intensity is shared.
struct Autd3Budget {
  int slots = 8;
  int divider = 6;  ///< periods of 40 kHz per sample
  int block_samples = 0;
  int block_frames = 0;        ///< frames of a block
  double block_time = 0.0;     ///< [s]
  double frames_per_ms = 0.0;  ///< frames that the link carries
  /// Share of the link that blocks take, including the frame that keeps each block audible.
  double load = 0.0;
  /// Share of the time available to write a block: from the answer that reports a free segment
  /// until the previous block begins to fall silent.
  double urgency = 0.0;

  double sample_rate() const;  ///< [Hz]
  double step() const;         ///< between samples of a focal point at 7 m/s [m]
};

inline constexpr double kAutd3DrawSpeed = 7.0;                              ///< [m/s]
inline constexpr double kAutd3ShortBlock = 10e-3, kAutd3LongBlock = 20e-3;  ///< [s]

/// Number of frames of a segment, which hold whole samples: up to 74 slots in the first frame, and
/// 77 in each of the others.
int autd3_frames(int slots, int samples);

/// Returns the budget of samples in blocks of about this time [s].
/// @param slow_frame time that a slow frame takes [s]; 0: the same as any other.
Autd3Budget autd3_budget(int slots, int divider, double block_time, double frames_per_ms,
                         double slow_frame = 0.0);

/// Returns the budget with the highest sampling rate, up to 10 kHz, at which blocks are written in
/// time; with short blocks if the link allows it.
/// @param block_time [s]; 0: 10 ms or 20 ms.
/// @throws std::invalid_argument if the link is too slow for 2 kHz.
Autd3Budget best_autd3_budget(int slots, double frames_per_ms, double slow_frame = 0.0,
                              double block_time = 0.0);

/// A table of budgets: slots × dividers × blocks × three numbers of frames per ms. The last index
/// is the fastest.
std::vector<Autd3Budget> autd3_budgets();

}  // namespace prostm
