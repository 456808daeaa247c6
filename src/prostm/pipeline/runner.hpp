#pragma once
/// Runs a pipeline for a given time, in steps or on threads, and returns a summary.

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
  RealTime,  ///< world, planner and device on threads, paced by the clock; late work is skipped and
             ///< counted
  AsFastAsPossible,  ///< world and planner on threads without a clock; nothing is dropped
  Stepped  ///< Pipeline::step on the caller's thread; the plans are bit-identical to those of
           ///< AsFastAsPossible
};
template <>
inline constexpr std::array<std::string_view, 3> kNames<RunMode> = {
    "realtime", "as-fast-as-possible", "stepped"};

/// Returns why a device cannot play in a mode, as a clause that follows its name; empty if it can.
std::string mode_problem(const DeviceInfo& device, RunMode mode);

struct RunOptions {
  double seconds = 60.0;  ///< run time [s]
  RunMode mode = RunMode::RealTime;
  /// In real time, whether the work of a step that needs no hands is done before they are taken.
  /// false: afterwards, as in the paper, for comparison.
  bool prepare_early = true;
  LiveLink* live = nullptr;  ///< lets viewers watch and control a real-time run
  bool stay = false;         ///< continue after `seconds`, until the observer stops the run
  /// A paused run resumes when it has had no viewer for this time [s].
  double pause_kept = 3.0;
};

/// The numbers of a run; times in seconds, lengths in metres.
struct RunSummary {
  RunMode mode = RunMode::RealTime;
  double seconds = 0;    ///< run time; shorter than requested if stopped
  double took = 0;       ///< elapsed time, including pauses
  bool stopped = false;  ///< by the observer or a failure
  /// The exception that ended the run, thrown by an observer, the hands, a stage or the end of the
  /// device; null without one.
  std::exception_ptr failure;
  std::int64_t world_steps = 0, skipped_world_steps = 0, plans = 0, empty_updates = 0,
               skipped_updates = 0;
  std::int64_t unobserved = 0;  ///< plan updates dropped because the observer was too slow
  std::int64_t long_paths = 0, crossings = 0;  ///< over all plans
  /// Updates whose target should be a stimulus, and those among them that passed its gate.
  std::int64_t judged_updates = 0, passed_updates = 0;
  std::int64_t late_page_hands = 0, hidden_page_hands = 0;  ///< PageHandReport
  /// Judged updates of a hand that had been held well for kSettled, the time that the air needs to
  /// reach it; those that passed; and the most frequent problem of the others.
  std::int64_t held_updates = 0, held_passed_updates = 0;
  GateProblem held_problem = GateProblem::None;
  static constexpr double kSettled = 5.0;  ///< [s]
  Adviser adviser;                         ///< options advised during the run
  ContactStats contact_stats;              ///< over all updates
  DeviceInfo played_by;
  DeviceStats device;
  EmitStats emit;
  /// Samples changed by the limiter before the device because of an error in a stage.
  std::int64_t limited_samples = 0;
  SafetyStats safety;
  double max_path_length = 0, max_skin_length = 0;
  /// Quantities of the world, and their means over its steps; those of the last world, if a run had
  /// several.
  std::span<const WorldQuantity> world_quantities;
  std::array<double, kMaxWorldQuantities> world_means = {};
  std::int64_t world_resets = 0;
  double full_scale_pressure = 0;  ///< rendered pressure at intensity 1 [Pa]
  Summary latency, redraw;
  /// By LatencyPart; their means add up to the mean latency.
  std::array<Summary, kLatencyParts> latency_parts;
  Summary track, hand, world, contact, plan, lift;  ///< times of the stages
  /// Loop period [s] and focal-point speed [m/s] as played, over all paths of all plans.
  Summary lap, focus_speed;
};

template <>
std::span<const Quantity<RunSummary>> quantities<RunSummary>();

/// The times of a stage in a summary.
struct StageSummary {
  const char* name;
  Summary RunSummary::*times;
};
std::span<const StageSummary> stage_summaries();

/// Receives every plan update on the thread that called run(). A slow observer does not delay a
/// real-time run: updates that it misses are counted in RunSummary::unobserved. An exception from
/// an observer ends the run.
class RunObserver {
 public:
  virtual ~RunObserver() = default;
  /// @return false to stop the run.
  virtual bool on_plan(const WorldFrame& contact, const PlanFrame& plan) = 0;
  /// Called regularly with the run time so far [s]. @return false to stop the run.
  virtual bool on_progress(double time) = 0;
  /// Called in real time with a sentence: the rates are not held, with advice, or they are held
  /// again.
  virtual void on_rates(const std::string& news) { static_cast<void>(news); }
  /// Called when the run's seconds are over and it continues (RunOptions::stay).
  virtual void on_summary(const RunSummary& summary) { static_cast<void>(summary); }
  /// Called when a paused run resumed because its last viewer left; run time [s].
  virtual void on_abandoned_pause(double time) { static_cast<void>(time); }
};

/// Runs `pipeline` from its beginning. On return, even after a failure, all threads have ended, the
/// output has faded out, and the device is stopped. @return the summary of options.seconds, or less
/// if the run was stopped, with any failure. @pre not run or stepped before; the device suits the
/// mode, see mode_problem(); options.live and options.stay only in real time.
RunSummary run(Pipeline& pipeline, const PipelineSettings& settings, const RunOptions& options,
               RunObserver& observer);

}  // namespace prostm
