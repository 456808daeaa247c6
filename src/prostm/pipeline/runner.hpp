#pragma once
/// Runs a pipeline for a while, in steps or on threads, and tells how it went.

#include <array>
#include <cstdint>
#include <exception>
#include <span>
#include <string>

#include "prostm/core/distribution.hpp"
#include "prostm/core/quantity.hpp"
#include "prostm/core/text/names.hpp"
#include "prostm/pipeline/latency.hpp"
#include "prostm/pipeline/pipeline.hpp"
#include "prostm/pipeline/realtime/advice.hpp"

namespace prostm {

struct LiveLink;

enum class RunMode : std::uint8_t {
  RealTime,  ///< world, planner and device on threads, paced by the clock; what cannot be kept up
             ///< with is skipped and counted
  AsFastAsPossible,  ///< world and planner on threads without a clock; nothing is dropped
  Stepped  ///< Pipeline::step on the caller's thread; the same plans as AsFastAsPossible, to the
           ///< bit
};
template <>
inline constexpr std::array<std::string_view, 3> kNames<RunMode> = {
    "realtime", "as-fast-as-possible", "stepped"};

/// Says why a device cannot play in a mode, to follow its name; empty if it can.
std::string mode_problem(const DeviceInfo& device, RunMode mode);

struct RunOptions {
  double seconds = 60.0;  ///< of run time
  RunMode mode = RunMode::RealTime;
  /// In real time, what a step does without the hands is done before they are taken; false:
  /// after that, as the paper does, to compare.
  bool prepare_early = true;
  LiveLink* live = nullptr;  ///< lets onlookers see and steer a run in real time
  bool stay = false;         ///< goes on after `seconds`, until the observer stops it
  /// A run that is paused goes on when nobody has looked at it for this long [s].
  double pause_kept = 3.0;
};

/// The numbers of a run; times in seconds, lengths in metres.
struct RunSummary {
  RunMode mode = RunMode::RealTime;
  double seconds = 0;    ///< of run time, shorter than asked when stopped
  double took = 0;       ///< by the clock, pauses included
  bool stopped = false;  ///< by the observer, or by what failed
  /// The first exception that ended the run, thrown by an observer, the hands, a stage or the
  /// device's end; null without one.
  std::exception_ptr failure;
  std::int64_t world_steps = 0, skipped_world_steps = 0, plans = 0, empty_updates = 0,
               skipped_updates = 0;
  std::int64_t unobserved = 0;                 ///< plan updates that the observer was too slow for
  std::int64_t long_paths = 0, crossings = 0;  ///< of all plans
  /// Updates whose target is a stimulus, and those of them that passed its gate.
  std::int64_t judged_updates = 0, passed_updates = 0;
  std::int64_t late_page_hands = 0, hidden_page_hands = 0;  ///< PageHandReport
  /// Judged updates of a hand that had been held well for kSettled, which the air needs
  /// to come up to it; those of them that passed; and the most frequent fault of the others.
  std::int64_t held_updates = 0, held_passed_updates = 0;
  GateProblem held_problem = GateProblem::None;
  static constexpr double kSettled = 5.0;  ///< [s]
  Adviser adviser;                         ///< options that were advised during the run
  ContactStats contact_stats;              ///< of all updates
  DeviceInfo played_by;
  DeviceStats device;
  EmitStats emit;
  /// Samples that the limiter before the device changed because a stage erred.
  std::int64_t limited_samples = 0;
  SafetyStats safety;
  double max_path_length = 0, max_skin_length = 0;
  /// Quantities of the world, and their means over its steps; of the last world, if a run had
  /// several.
  std::span<const WorldQuantity> world_quantities;
  std::array<double, kMaxWorldQuantities> world_means = {};
  std::int64_t world_resets = 0;
  double full_scale_pressure = 0;  ///< rendered pressure at intensity 1 [Pa]
  Summary latency, redraw;
  std::array<Summary, kLatencyParts> latency_parts;  ///< by LatencyPart; their means add up to the
                                                     ///< mean latency
  Summary track, hand, world, contact, plan, lift;   ///< of the stages
  /// Period of a lap [s] and speed of the focal point [m/s] as played, over all paths of all plans.
  Summary lap, focus_speed;
};

template <>
std::span<const Quantity<RunSummary>> quantities<RunSummary>();

/// A stage's times in a summary.
struct StageSummary {
  const char* name;
  Summary RunSummary::*times;
};
std::span<const StageSummary> stage_summaries();

/// Sees every plan update on the thread that called run(). Slow observers delay nothing in real
/// time: what they miss is counted in RunSummary::unobserved. What an observer throws ends the run.
class RunObserver {
 public:
  virtual ~RunObserver() = default;
  /// @return false to stop the run.
  virtual bool on_plan(const WorldFrame& contact, const PlanFrame& plan) = 0;
  /// Now and then, with the run time so far [s]. @return false to stop the run.
  virtual bool on_progress(double time) = 0;
  /// In real time: the rates are not held and what to do, or they are held again, in a sentence.
  virtual void on_rates(const std::string& news) { static_cast<void>(news); }
  /// The run's seconds are over, and it goes on (RunOptions::stay).
  virtual void on_summary(const RunSummary& summary) { static_cast<void>(summary); }
  /// A paused run resumed because its last viewer left; run time [s].
  virtual void on_abandoned_pause(double time) { static_cast<void>(time); }
};

/// Runs `pipeline` from its beginning. However it ends, whatever fails and on whichever thread, all
/// threads have ended then, the output has faded out, and the device is stopped. @return the
/// summary of options.seconds, or of less when it was stopped; what failed is in it. @pre not run
/// or stepped before; the device keeps time as the mode asks; options.live and
/// options.stay only in real time.
RunSummary run(Pipeline& pipeline, const PipelineSettings& settings, const RunOptions& options,
               RunObserver& observer);

}  // namespace prostm
