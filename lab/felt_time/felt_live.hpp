#pragma once
/// The percept of plans that replace one another while they are played.

#include <functional>
#include <span>
#include <vector>

#include "felt_time/time_skin.hpp"
#include "prostm/acoustics/array/array.hpp"
#include "prostm/core/worker_pool.hpp"
#include "prostm/emit/emitter.hpp"
#include "prostm/plan/plan.hpp"
#include "prostm/score/loop_drives.hpp"
#include "prostm/score/score.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm::bench {

/// A plan, and its target.
struct LivePlan {
  Plan plan;
  TargetField target;
};

struct LiveSettings {
  /// Without a full scale, the largest pressure of all plans is intensity 1.
  EmitSettings emit;
  /// Without a full scale, it is the lowest that the array can sustain over the loops of five of
  /// the plans.
  LoopDriveSettings drives;
  double sample_rate = 40e3;  ///< [Hz]
  double interval = 0.040;    ///< time between plans [s], whole ms
  double settling = 0.25;     ///< time from the start that is played but not judged [s]
};

struct LiveFelt {
  std::vector<double> percept;      ///< √e over all that is judged, (S7) [m]; 0 off the skin
  std::vector<double> mean_target;  ///< of the plans that are judged
  Metrics metrics;                  ///< of the percept against the mean target
  double intensity = 0.0;           ///< √(∫ e dA / A_0) [m], as (S8) if nothing is below 57 Hz
  std::vector<double> window_percept;  ///< √e [m] of each kFeltWindow, rows·cols each
  std::vector<double> window_skill_8;  ///< of each window against the target planned at the time
  EmitStats emit;
  std::int64_t short_samples = 0;  ///< samples weaker than requested
};

/// Plays plans one after the other with the emitter of `method`, computes the pressure of the array
/// on the skin for every kFeltTick, and the percept in time. Take-overs are those of a live run.
/// @param plans all targets on one raster. @param skin its patch is that raster's.
/// @param progress called with ticks done and all; returning false stops.
/// @return false if stopped; `out` is then unspecified.
/// @throws std::invalid_argument for no plan, plans or a target without pressure, rasters that
/// differ from each other or from the skin's patch, a sample rate that is not a multiple of 5 kHz,
/// settling that leaves no whole window, and as Emitter and RunningDrives do.
bool felt_live(Method method, std::span<const LivePlan> plans, const LiveSettings& settings,
               const TransducerArray& array, const TimeSkin& skin, WorkerPool& pool,
               const std::function<bool(std::size_t done, std::size_t all)>& progress,
               LiveFelt& out);

}  // namespace prostm::bench
