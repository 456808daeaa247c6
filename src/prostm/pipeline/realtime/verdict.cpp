#include "prostm/pipeline/realtime/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "prostm/core/text/number_text.hpp"
#include "prostm/pipeline/smoke/scene_grids.hpp"

namespace prostm {
namespace {

constexpr std::size_t kMostSentences = 4;  // as many as a newcomer reads in ten seconds

// A missing step stops the smoke for 20 ms; a missing plan repeats the paths once or twice. One in
// a hundred is a hiccup every two seconds at most.
constexpr double kLeastDone = 0.99;
// A missed block is a gap; with blocks of 1 ms, this is one gap per second.
constexpr double kMostMissed = 1e-3;
// Shares above which a fault is reported. They are well above those of a cycle of the scripted hand
// in the scenes: at most 16 % of the samples at full scale, none limited or capped, 7 % of the
// joints outside the box as the hand enters, 11 % of its skin steep.
constexpr double kMostSaturated = 0.25, kMostLimited = 0.1, kMostOutside = 0.25, kMostSteep = 0.5,
                 kMostCapped = 0.01;
constexpr std::int64_t kLeastHeld = 25;  // fewest updates of a held hand to judge it
constexpr double kComesIn = 10.0;        // shorter runs are mostly the hand entering the box [s]
// Tolerated share of a tracker's frames.
constexpr double kMostDropped = 0.01;

/// @param of_none result if `all` is 0.
double share(std::int64_t part, std::int64_t all, double of_none = 0.0) {
  return all > 0 ? static_cast<double>(part) / static_cast<double>(all) : of_none;
}
std::int64_t slots(const RunSummary& s) {
  return s.world_steps + s.skipped_world_steps;
}

/// Sentences on the most likely reason for missing steps or plans, and the remedy. @pre a step was
/// made.
std::string reason(const RunSummary& s, const PipelineSettings& settings) {
  const double due = 1.0 / settings.world_rate;
  const double steps_per_plan = settings.steps_per_plan();
  // the stages that run on one thread
  const WorkTime work{s.track.p50 + s.hand.p50 + s.world.p50 + s.contact.p50 / steps_per_plan,
                      s.plan.p50 + s.lift.p50};
  Adviser adviser = s.adviser;  // keeps the option advised during the run
  const Advice advice = adviser.advise(work, settings);
  const std::string what_to_do = sentence(advice, settings);
  switch (advice.cause) {
    case Busy::Step:
      return fmt::format("A step takes {:.1f} ms (median); the budget is {:.0f} ms. {}",
                         1e3 * work.step, 1e3 * due, what_to_do);
    case Busy::Plan:
      return fmt::format("A plan takes {:.1f} ms (median); the budget is {:.0f} ms. {}",
                         1e3 * work.plan, 1e3 * due * steps_per_plan, what_to_do);
    case Busy::Neither:
      break;
  }
  return fmt::format(
      "A step takes {:.1f} ms (median) of its {:.0f} ms, but up to {:.0f} ms: another program "
      "takes the processor now and then. {}",
      1e3 * work.step, 1e3 * due, 1e3 * (s.track.max + s.hand.max + s.world.max), what_to_do);
}

/// "twice", "3 times".
std::string times_text(std::int64_t n) {
  return n == 1 ? "once" : n == 2 ? "twice" : fmt::format("{} times", n);
}

/// Measured causes of missed blocks, the most frequent first.
std::string gap_causes(const RunSummary& s) {
  const DeviceStats& d = s.device;
  const std::int64_t late = d.missed_blocks - d.lost_blocks - d.slow_blocks;
  std::vector<std::pair<std::int64_t, std::string>> causes;
  if (d.lost_blocks > 0)
    causes.emplace_back(
        d.lost_blocks,
        fmt::format("its link was lost {} ({:.1f} s without a link)", times_text(d.lost_links),
                    static_cast<double>(d.lost_blocks) * s.played_by.block_time()));
  if (d.slow_blocks > 0)
    causes.emplace_back(d.slow_blocks,
                        fmt::format("its link was too slow for {} of {} blocks (use longer blocks, "
                                    "or a faster link)",
                                    d.slow_blocks, d.blocks));
  if (late > 0)
    causes.emplace_back(
        late, fmt::format("its thread woke too late for {} of {} blocks (allow it real-time "
                          "priority, ulimit -r 10, or close other programs)",
                          late, d.blocks));
  std::ranges::stable_sort(causes, std::greater{}, [](const auto& cause) { return cause.first; });
  std::string all;
  for (const auto& [count, text] : causes) all += (all.empty() ? "" : "; ") + text;
  return all;
}

void judge_rates(const RunSummary& s, const PipelineSettings& settings, Verdict& out) {
  const bool in_time = world_rate(s, settings).held() && plan_rate(s, settings).held();
  out.held = in_time && samples_held(s);
  const std::string rates = rates_text(s, settings);
  const std::string missed =
      fmt::format("{} of {} blocks", s.device.missed_blocks, s.device.blocks);
  if (*out.held) {
    out.sentences.push_back(fmt::format(
        "The rates were held: {}, {:.4g} samples a millisecond{}.", rates,
        1e-3 * s.played_by.sample_rate,
        s.device.missed_blocks > 0 ? fmt::format(" ({} missed, hardly noticeable)", missed) : ""));
    return;
  }
  if (!in_time) {
    out.sentences.push_back(
        fmt::format("The rates were not held: {}. {}", rates, reason(s, settings)));
  }
  if (samples_held(s)) return;
  out.sentences.push_back(fmt::format(
      "{} array was silent for {:.0f} ms in all, which is felt as gaps: {}.",
      in_time ? fmt::format("Smoke and plans kept their rates ({}), but the", rates) : "The",
      1e3 * static_cast<double>(s.device.missed_blocks) * s.played_by.block_time(), gap_causes(s)));
}

/// Describes the gate's problem with the fields of a held hand.
std::string fault_text(GateProblem problem) {
  switch (problem) {
    case GateProblem::Maxima:
      return "a wrong number of maxima";
    case GateProblem::Balance:
      return "unequal maxima";
    case GateProblem::Saddle:
      return "maxima that merge";
    case GateProblem::Area:
      return "a wrong area";
    case GateProblem::Force:
      return "a wrong force";
    default:
      return "varying problems";
  }
}

/// Reports a hand that was held well for long enough but did not get the stimulus.
void judge_stimulus(const RunSummary& s, const PipelineSettings& settings,
                    std::vector<std::string>& out) {
  const double passed = share(s.held_passed_updates, s.held_updates);
  if (s.held_updates < kLeastHeld || passed >= kKeptShare) return;
  const int cells = settings.fluid.cells;
  const bool coarse = grid_effect(settings, cells) == GridEffect::Loses;
  const ComparedText text = compared_text(100.0 * passed, 100.0 * kKeptShare, 0);
  out.push_back(fmt::format(
      "The held hand did not get the stimulus of {}: {} % of its updates passed the gate (at least "
      "{} %), mostly for {}. {}",
      settings.scene, text.value, text.bound, fault_text(s.held_problem),
      coarse ? fmt::format("--grid {} is too coarse for this scene: use --grid {}.", cells,
                           finer_grid(settings.scene, cells))
             : "Put the jets under the hand (place = \"hand\" in [jets]), and hold it flat "
               "(docs/guides/hands.md)."));
}

void judge_pace(const RunSummary& s, Verdict& out) {
  const bool is_faster = s.took < s.seconds;
  const double ratio = is_faster ? s.seconds / std::max(s.took, 1e-9) : s.took / s.seconds;
  const std::string pace = ratio < 1.05 ? "as fast as real time"
                                        : fmt::format("{:.1f} times {} than real time", ratio,
                                                      is_faster ? "faster" : "slower");
  out.sentences.push_back(fmt::format(
      "{:.1f} s of the scene were computed in {:.1f} s, {}; without a clock there are no "
      "rates to hold.",
      s.seconds, s.took, pace));
}

void judge_tracker(const TrackerStatus& tracker, std::vector<std::string>& out) {
  const double refused = share(tracker.dropped + tracker.repeated, tracker.frames);
  if (tracker.frames == 0) {
    out.push_back(fmt::format("No hand frame ever arrived: {}.", tracker.sentence));
  } else if (!tracker.connected) {
    out.push_back(fmt::format("The tracker was lost and had not come back at the end: {}.",
                              tracker.sentence));
  } else if (tracker.reconnects > 0) {
    out.push_back(
        fmt::format("The tracker was lost {} times and came back; meanwhile there was no hand, "
                    "and nothing was felt.",
                    tracker.reconnects));
  } else if (refused > kMostDropped) {
    out.push_back(fmt::format("{:.0f} % of the tracker's {} frames were discarded: {}.",
                              100.0 * refused, tracker.frames, tracker.sentence));
  }
}

void judge_contact(const ContactStats& contact, double seconds, bool felt, BoxFollows follows,
                   std::vector<std::string>& out) {
  const double outside = share(contact.joints_outside, contact.joints);
  constexpr const char* kRemedy = "hold it above the array, or check --tracker";
  if (!felt && contact.joints == 0) {
    out.emplace_back("No hand was in sight, so nothing was felt.");
  } else if (!felt && contact.skin_cells == 0) {
    out.push_back(fmt::format(
        "The hand never faced the array in the smoke's box, so nothing was felt: {}.", kRemedy));
  } else if (!felt) {
    out.emplace_back("No pressure reached the hand, so nothing was felt.");
  } else if (follows == BoxFollows::Nothing && seconds > kComesIn && outside > kMostOutside) {
    // a box that follows one point may not contain the whole hand
    out.push_back(
        fmt::format("{:.0f} % of the hand's joints were outside the smoke's box, where nothing is "
                    "felt: {}.",
                    100.0 * outside, kRemedy));
  }
  const double steep = steep_share(contact);
  if (steep > kMostSteep) {
    out.push_back(
        fmt::format("{:.0f} % of the hand's skin was too steep for the array to press on: turn the "
                    "palm towards it.",
                    100.0 * steep));
  }
}

void judge_output(const RunSummary& s, std::vector<std::string>& out) {
  const double saturated = share(s.emit.saturated, s.emit.samples),
               limited = share(s.emit.limited, s.emit.samples);
  if (saturated > kMostSaturated) {
    out.push_back(fmt::format(
        "{:.0f} % of the samples were at full scale, {:.3g} Pa, where stronger pressure feels "
        "the same. Raise full_scale_pressure in [emit] (--settings).",
        100.0 * saturated, s.full_scale_pressure));
  }
  if (limited > kMostLimited) {
    out.push_back(fmt::format(
        "{:.0f} % of the samples were weakened by the power limit: raise power_limit in "
        "[emit] (--settings), or use fewer --paths.",
        100.0 * limited));
  }
  if (s.unobserved > 0) {
    out.push_back(
        fmt::format("{} updates are missing in the recording or for the picture: writing was too "
                    "slow. Record to a faster disk.",
                    s.unobserved));
  }
}

/// Reports unrequested releases of a page's hand, since they change the output.
void judge_page_hand(const RunSummary& s, std::vector<std::string>& out) {
  if (s.hidden_page_hands > 0) {
    out.push_back(fmt::format(
        "The page's hand was released because its page was hidden ({}×): keep the page in front "
        "while its hand is in use.",
        s.hidden_page_hands));
  }
  if (s.late_page_hands > 0) {
    out.push_back(fmt::format(
        "The page's hand was released because no message came from its page for 0.5 s ({}×): keep "
        "the page in front, and close what slows the browser down.",
        s.late_page_hands));
  }
}

/// Reports plans that were not played unchanged.
void judge_played(const RunSummary& s, std::vector<std::string>& out) {
  if (s.emit.changed_paths > 0) {
    out.push_back(fmt::format(
        "{} paths were played at another speed than planned, up to {:.2f} m/s; the limit for focal "
        "points is {:.4g} m/s.",
        s.emit.changed_paths, s.focus_speed.max, s.played_by.max_focus_speed()));
  }
  if (s.emit.dropped_paths > 0) {
    out.push_back(
        fmt::format("{} paths or foci of plans were not played because there were fewer focal "
                    "points: raise foci in [emit] (--settings), or use fewer --paths.",
                    s.emit.dropped_paths));
  }
}

/// Reports faults that should never occur.
void judge_faults(const RunSummary& s, std::vector<std::string>& out) {
  if (s.world_resets > 0) {
    out.push_back(fmt::format(
        "The smoke simulation failed {} times and restarted at rest: ignore what was felt "
        "then.",
        s.world_resets));
  }
  if (s.limited_samples > 0) {
    out.push_back(fmt::format(
        "{} samples were outside the device's limits and were clamped: an earlier stage is at "
        "fault.",
        s.limited_samples));
  }
}

/// Reports samples weakened by the caps of [safety].
void judge_safety(const RunSummary& s, std::vector<std::string>& out) {
  const double capped = share(capped_samples(s.safety), s.emit.samples);
  if (capped <= kMostCapped) return;
  out.push_back(fmt::format(
      "{:.0f} % of the samples were weakened to keep the caps of [safety], most of them for {}: "
      "hold the hand farther from the array, or use fewer --paths (docs/devices/safety.md).",
      100.0 * capped, main_cap(s.safety)));
}

}  // namespace

std::vector<std::string> unusual_in(const HandReading& reading) {
  const HandFaults& faults = reading.faults;
  std::vector<std::string> out;
  if (!reading.doubt.empty()) out.push_back(fmt::format("In {} {}.", reading.file, reading.doubt));
  if (!faults.any()) return out;
  out.push_back(fmt::format(
      "{} of {} frames and {} of {} hands in the recording were dropped ({}). The first: {}.",
      faults.frames(), reading.frames, faults.hands(), reading.hands, causes_of(faults),
      faults.first));
  return out;
}

bool HeldRate::held() const {
  return done >= kLeastDone * due;
}

std::string rates_text(const RunSummary& s, const PipelineSettings& settings) {
  const HeldRate world = world_rate(s, settings), plans = plan_rate(s, settings);
  return fmt::format("smoke {:.1f} of {:.0f} Hz, plans {:.1f} of {:.0f} Hz", world.done, world.due,
                     plans.done, plans.due);
}

HeldRate world_rate(const RunSummary& s, const PipelineSettings& settings) {
  const double due = settings.world_rate;
  return {due * share(s.world_steps, slots(s), 1.0), due};
}

/// Targets are made every steps_per_plan steps, so skipped steps also skip targets.
HeldRate plan_rate(const RunSummary& s, const PipelineSettings& settings) {
  const std::int64_t made = s.plans + s.empty_updates;
  const double due = settings.world_rate / settings.steps_per_plan();
  return {due * share(made, made + s.skipped_updates, 1.0) * share(s.world_steps, slots(s), 1.0),
          due};
}

bool samples_held(const RunSummary& s) {
  return share(s.device.missed_blocks, s.device.blocks) <= kMostMissed;
}

Verdict verdict_of(const RunSummary& s, const PipelineSettings& settings,
                   const std::optional<TrackerStatus>& tracker, const HandReading* reading) {
  Verdict verdict;
  if (s.world_steps == 0 || !(s.seconds > 0.0)) {
    verdict.sentences.emplace_back("The run ended before its first step.");
    return verdict;
  }
  judge_stimulus(s, settings, verdict.sentences);
  const bool stimulus = verdict.sentences.empty();
  if (s.mode == RunMode::RealTime) {
    judge_rates(s, settings, verdict);
  } else {
    judge_pace(s, verdict);
  }
  std::vector<std::string> unusual;
  judge_faults(s, unusual);
  judge_safety(s, unusual);
  judge_played(s, unusual);
  if (tracker) judge_tracker(*tracker, unusual);
  if (reading != nullptr) {
    for (std::string& sentence : unusual_in(*reading)) unusual.push_back(std::move(sentence));
  }
  if (!tracker || tracker->frames > 0) {
    judge_contact(s.contact_stats, s.seconds, s.plans > 0, settings.box.follow, unusual);
  }
  judge_page_hand(s, unusual);
  judge_output(s, unusual);
  if (unusual.empty() && stimulus && verdict.held.value_or(true))
    verdict.sentences.emplace_back("Nothing was unusual.");
  const std::size_t room = kMostSentences - verdict.sentences.size();
  unusual.resize(std::min(unusual.size(), room));
  verdict.sentences.insert(verdict.sentences.end(), unusual.begin(), unusual.end());
  return verdict;
}

}  // namespace prostm
