#pragma once
/// Plans as focal points over time: sampling, transitions, drive law, fade-out.

#include <cstdint>
#include <memory>
#include <string>

#include "core/settings.hpp"
#include "emit/focus_sample.hpp"
#include "plan/lifted_plan.hpp"

namespace prostm {

/// Of a focal point that sounds [m/s]; where a path asks for more its laps take longer.
inline constexpr double kMaxFocusSpeed = 8.0;

struct EmitSettings {
  int foci = 4;                      ///< focal points, 1..8
  double full_scale_pressure = 0.0;  ///< that maps to intensity 1 [unit of the target]; > 0
  double silent_below = 0.01;        ///< share of full scale under which a sample is silent
  double power_limit = 4.0;          ///< largest Σ intensity² over simultaneous focal points, > 0
  std::string switch_at = "lap";  ///< take-over at each path's lap end, or "now": at the next block
  double fade_time = 1e-3;    ///< of a fade down or up over the full range [s], at least 40 samples
  double stall_time = 0.100;  ///< without a new plan for this long, the output fades [s]
  double stall_fade_time = 0.010;  ///< that fade, and the one after lose() [s], at most 40 ms

  void visit(SettingsVisitor& v);
};

/// @throws std::invalid_argument with a sentence that names the setting, its value and its bound;
/// the sample rate [Hz] must be 1 kHz to 1 MHz.
void validate(const EmitSettings& settings, double sample_rate);

/// The drive law, (E4): intensity = sqrt(pressure / full scale), since radiation pressure goes with
/// the square of acoustic pressure; clipped to 1, 0 below the silent share and for negative
/// pressure. `saturated` is set when it was clipped. @pre full_scale > 0, both finite.
double drive_intensity(double pressure, double full_scale, double silent_below, bool& saturated);

/// The largest intensity², or share of full scale's radiation pressure, that `paths` focal points
/// may have at the same time when they want the same, (E4a): min(1, power_limit / paths).
/// @pre paths ≥ 1, power_limit > 0.
double even_share(int paths, double power_limit);

/// Something that the pipeline wants to know of the emission, in sample counts.
struct TakeOver {
  std::int64_t plan = 0;             ///< id of the plan
  std::int64_t first_sample = 0;     ///< first sample that follows it
  std::int64_t redrawn_sample = -1;  ///< when 90 % of its path length was drawn; −1: never
};

struct EmitStats {
  std::int64_t samples = 0;    ///< emitted, per focal point summed
  std::int64_t saturated = 0;  ///< clipped at full scale
  std::int64_t limited = 0;    ///< scaled down by the power limit
  std::int64_t faded = 0;      ///< in a fade of a transition
  std::int64_t laps_started = 0, laps_cut = 0;
  std::int64_t stalls = 0;         ///< fade-outs because no plan came
  std::int64_t refused_plans = 0;  ///< with a number that is not finite or out of bounds
  std::int64_t dropped_paths = 0;  ///< paths beyond the number of focal points, not drawn
  double max_focus_step = 0.0;     ///< between samples while intensity > 1 % [m]
};

/// Turns plans into samples. submit() and lose() belong to one thread, fill() to another; neither
/// waits.
///
/// Guarantees, for any sequence of plans: while its intensity is above 1 % a focal point moves at
/// most 8 m/s (0.2 mm between samples at 40 kHz), its intensity changes by at most 1/40 per sample,
/// intensities lie in [0, 1], Σ intensity² is within the limit, and every number is finite.
///
/// A new plan's paths are matched to the focal points, (E5). Each focal point goes over at the end
/// of its lap (at the next block with switch_at = "now", or when a lap takes over 1 s): by moving,
/// when the new path is near, (E3), else by fading down, jumping while silent, and fading up. Those
/// that all start from silence begin at their paths' first points, one that joins others which run
/// where it keeps away from them, (E6). A focal point that no path needs fades down and rests where
/// it is. docs/design.md, section 7.
class PathEmitter final : public SampleSource {
 public:
  /// @param sample_rate of the device [Hz]. @throws as validate() does.
  PathEmitter(const EmitSettings& settings, double sample_rate);
  ~PathEmitter() override;

  /// The slot for the next plan; fill it, then submit(). What is in it before is of no meaning.
  /// Planner's thread.
  LiftedPlan& draft();
  /// Hands the draft over; a plan that the device had not fetched yet is replaced. Arc lengths are
  /// computed anew. A plan with a number that is not finite, a coordinate beyond 10 m, or pressures
  /// that do not match its points is counted as refused and treated as lose(). Planner's thread.
  void submit() noexcept;
  /// The hand is gone, or a number was not finite: fade out within 50 ms, until the next plan.
  /// Planner's thread.
  void lose() noexcept;

  int foci() const override;
  void fill(std::int64_t first, std::span<FocusSample> out) noexcept override;

  /// The oldest report that was not read, once 90 % of a plan has been drawn or nothing follows it
  /// any more; false when there is none. Keeps 1024, later ones are lost. Planner's thread.
  bool next_take_over(TakeOver& out);
  /// A copy of the counters as of the last block. Any one thread.
  EmitStats stats() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace prostm
