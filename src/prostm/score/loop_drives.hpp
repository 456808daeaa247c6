#pragma once
/// What an array does to play a loop of focal points: drives, and what the transducers make of
/// them.

#include <functional>

#include "prostm/acoustics/drive_basis.hpp"
#include "prostm/acoustics/focus_solver.hpp"
#include "prostm/acoustics/propagation_kernels.hpp"
#include "prostm/acoustics/transducer.hpp"
#include "prostm/emit/loop_samples.hpp"

namespace prostm {

struct LoopDriveSettings {
  FocusSettings focus;
  TransducerSettings transducer;
  /// Acoustic pressure of a focal point of intensity 1 [Pa, rms]; 0: the most that the array can
  /// hold over the whole loop, so that no sample is weaker than its plan says.
  double full_scale_pa = 0.0;
};

struct LoopDriveResult {
  LoopDrives output;               ///< what the transducers put out, in the place of drives in (A1)
  double full_scale_pa = 0.0;      ///< acoustic pressure of intensity 1 [Pa, rms]
  int short_samples = 0;           ///< that did not reach it
  double largest_drive = 0.0;      ///< |q|, 0..1
  double mean_power = 0.0;         ///< Σ_n |q_n|², mean over the loop
  double full_share = 0.0;         ///< of all transducers and samples, those with |q| > 0.99
  double worst_focus_error = 0.0;  ///< largest error of a focal point's share of its sample
  int merged = 0;                  ///< focal points left out since one stronger was within 0.1 mm
};

/// Drives for each sample by `solve_foci`, from the phases of the sample before, at one common
/// scale, then transducers' outputs once the loop repeats, (A10). Intensity 0 is no focal point.
/// @param progress called with samples done and all; false stops. @return false when it was
/// stopped; `out` is then of no meaning.
/// @throws std::invalid_argument as propagation_to(), solve_foci() and TransducerDynamics do, and
/// for a loop that is silent throughout, or a full scale that is negative or not finite.
bool loop_drives(const TransducerArray& array, const Medium& medium, const LoopSamples& loop,
                 const LoopDriveSettings& settings,
                 const std::function<bool(int done, int all)>& progress, LoopDriveResult& out);

}  // namespace prostm
