#pragma once
/// Drives of an array for a loop of focal points, and the resulting outputs of the transducers.

#include <functional>

#include "prostm/acoustics/array/transducer.hpp"
#include "prostm/acoustics/field/drive_basis.hpp"
#include "prostm/acoustics/field/propagation_kernels.hpp"
#include "prostm/acoustics/focus/focus_solver.hpp"
#include "prostm/emit/loop_samples.hpp"

namespace prostm {

struct LoopDriveSettings {
  FocusSettings focus;
  TransducerSettings transducer;
  /// Acoustic pressure of a focal point of intensity 1 [Pa, rms]; 0: the highest that the array can
  /// sustain over the whole loop, so that no sample is weaker than planned.
  double full_scale_pa = 0.0;
};

struct LoopDriveResult {
  LoopDrives output;               ///< outputs of the transducers; they replace the drives in (A1)
  double full_scale_pa = 0.0;      ///< acoustic pressure of intensity 1 [Pa, rms]
  int short_samples = 0;           ///< number of samples that do not reach full_scale_pa
  double largest_drive = 0.0;      ///< |q|, 0..1
  double mean_power = 0.0;         ///< Σ_n |q_n|², mean over the loop
  double full_share = 0.0;         ///< share of transducers and samples with |q| > 0.99
  double worst_focus_error = 0.0;  ///< largest error of a focal point's share of its sample
  int merged = 0;                  ///< focal points dropped for a stronger one within 0.1 mm
};

/// Computes drives for each sample by `solve_foci`, starting from the phases of the previous
/// sample, at one common scale; then the transducers' outputs in the periodic steady state, (A10).
/// Focal points of intensity 0 are ignored.
/// @param progress called with the number of samples done and in total; returning false stops.
/// @return false if stopped; `out` is then unspecified.
/// @throws std::invalid_argument as propagation_to(), solve_foci() and TransducerDynamics do, and
/// for a loop that is silent throughout, or a full scale that is negative, not finite or above 1e6
/// Pa.
bool loop_drives(const TransducerArray& array, const Medium& medium, const LoopSamples& loop,
                 const LoopDriveSettings& settings,
                 const std::function<bool(int done, int all)>& progress, LoopDriveResult& out);

}  // namespace prostm
