#pragma once
/// The planner's settings.

#include <algorithm>

#include "prostm/core/settings.hpp"
#include "prostm/plan/focus_speed.hpp"
#include "prostm/plan/focus_widths.hpp"
#include "prostm/plan/gain.hpp"
#include "prostm/plan/preset.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm {

/// Defaults are the paper's, or those of docs/design/planner.md where the paper is
/// silent.
struct PlanSettings {
  Preset preset = kDefaultPreset;
  int paths = 4;               ///< maximum number of paths, 1..8
  int clusters = 50;           ///< k of the weighted k-means, 1..50
  int samples = 20;            ///< N, points per path, 8..64; preset best uses fit_samples
  double speed = 7.0;          ///< v of the focal points [m/s]
  double draw_rate = 50.0;     ///< laps per second of the longest path [Hz], (P9a)
  double sigma = 8.6e-3;       ///< fall-off σ of a focal point in Eqs. (1) and (4) [m]
  double gain = 1.4;           ///< γ of the longest path: rendered over effective pressure, (P9b)
  double gain_exponent = 0.0;  ///< exponent of a path's period in its γ, (P9b); 0: one γ for all
  /// Whether γ of shorter paths comes from the skin model, (P9c), instead of the exponent.
  bool gain_from_skin = false;
  double weight_pressure = 3.0;      ///< weight of Eq. (2), p* over the frame's maximum
  double weight_length = 3.0;        ///< weight of Eq. (3), lengths in mm
  double weight_intersection = 1.0;  ///< weight of Eq. (4), lengths in mm
  double weight_bending = 0.3;       ///< weight of Eq. (5), angles in rad
  /// Points below this share of the frame's maximum are not clustered.
  double weak_pressure = 0.01;
  int lloyd_iterations = 100;   ///< maximum iterations of the k-means
  int refine_iterations = 200;  ///< maximum number of gradient steps
  int seed = 1;                 ///< seed of the clustering
  // presets best, fast and felt
  double least_length = 0.035;  ///< least length of a path [m]; L if that is shorter
  double fit_coverage = 0.12;   ///< weight of pressure that no path reaches, (P12)
  double fit_length = 1.0;      ///< weight of length and uneven samples, (P13)
  double fit_spacing = 0.3;     ///< weight of samples that are too near, (P14)
  double fit_bending = 0.03;    ///< weight of bending, (P15)
  /// Weight of the percept when presets best and fast choose pressures, 0 to 1, (P19); the field
  /// (P10) has the rest. 0: pressures are those of the fit. Preset felt plans its paths with it; it
  /// is not a setting in files.
  double felt_weight = 0.0;
  bool felt_points = false;  ///< with felt_weight: whether the points of paths move, too
  /// For preset felt: 1 − S_8.5 of the percept that a strength 2.7 times as high is worth, (P25).
  double strength_weight = 0.1;
  int fit_samples = 28;          ///< N in the search of best, 8..64; plans have 2 N, at most 64
  double fit_hysteresis = 0.03;  ///< share of the cost that a new set of paths must save
  int fit_starts = 4;            ///< sets of paths tried if there is no previous plan
  int fit_kicks = 8;             ///< attempts to re-initialise one or two paths
  /// Time after which `best` and `felt` try nothing more [s]; 0: only the counts apply, and the
  /// same input gives the same plan.
  double budget = 0.0;
  /// Rendered pressure at full output that presets best, fast and felt assume [unit of the target];
  /// 0: γ of the longest path times the frame's maximum.
  double full_scale_pressure = 0.0;
  /// Properties of the emission, not fields in files: the time of a rise from silence to full
  /// output [s], and the share of full output's pressure below which it is silent.
  double rise_time = 1e-3, silent_below = 0.01;
  /// For presets best, fast and felt: σ of each target by its position and tilt; if empty, `sigma`.
  /// Not stored in files.
  FocusWidths widths;
  /// Custom preset, used instead of `preset` if not null; must outlive the planner. Not stored in
  /// files; these contain `preset`.
  const PresetTraits* own_preset = nullptr;

  const PresetTraits& traits() const {
    return own_preset != nullptr ? *own_preset : traits_of(preset);
  }
  /// Number of points of a path that the search moves: `samples` or fit_samples.
  int moved_samples() const { return traits().moves_fit_samples ? fit_samples : samples; }

  /// Returns the σ that a target is planned with [m]. @pre the target is valid.
  double sigma_on(const TargetField& target) const;

  /// v of planned paths [m/s]: `speed`, at most kStepMargin of kMaxFocusSpeed, the margin for the
  /// rounding of samples, so that planned periods equal played ones.
  double path_speed() const { return std::min(speed, kStepMargin * kMaxFocusSpeed); }

  /// L [m], the length of a path that is drawn draw_rate times a second, (P9a).
  double max_length() const { return path_speed() / draw_rate; }

  /// Returns the law for γ of a path by its period.
  GainLaw gain_law() const { return {gain, gain_exponent, draw_rate, gain_from_skin}; }

  void visit(SettingsReader& v) const;
  void visit(SettingsWriter& v);
  bool operator==(const PlanSettings&) const = default;
};

/// @throws std::invalid_argument with a message that names the setting, its value and its bounds.
void validate(const PlanSettings& settings);

}  // namespace prostm
