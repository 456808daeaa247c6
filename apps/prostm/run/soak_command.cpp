#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <thread>

#include "common.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/stage_timer.hpp"
#include "prostm/device/realtime_limits.hpp"
#include "prostm/pipeline/realtime/cores.hpp"
#include "prostm/pipeline/realtime/soak_log.hpp"
#include "run/core_load.hpp"
#include "run/run_summary.hpp"
#include "run/view.hpp"

namespace prostm::app {
namespace {

constexpr int kDipped = 1;              // exit status
constexpr double kLookAtUse = 0.25;     // [s]
constexpr std::int64_t kMostSaid = 20;  // most dips of a part that the terminal shows

std::string name_of_part(int part, const SoakPart& of) {
  constexpr std::array<const char*, 3> kOrder = {"first", "second", "last"};
  return fmt::format("{} third, {}", kOrder[static_cast<std::size_t>(part)],
                     of.loaded ? "all cores loaded" : "quiet");
}

/// Counts dips, and loads the machine during the middle third.
class SoakObserver final : public RunObserver {
 public:
  SoakObserver(SoakLog& log, Pipeline& pipeline, const PipelineSettings& settings, double seconds,
               CoreLoad* load, const View* view, const Interrupt& interrupt, std::FILE* out)
      : log_(log),
        pipeline_(pipeline),
        settings_(settings),
        seconds_(seconds),
        load_(load),
        view_(view),
        interrupt_(interrupt),
        out_(out) {
    log_.use(0.0, machine_use());
  }

  bool on_plan(const WorldFrame& contact, const PlanFrame& plan) override {
    const std::int64_t slot = std::llround(contact.due * settings_.world_rate);
    counts_.skipped_steps = slot - contact.step;
    counts_.skipped_plans = contact.step / settings_.steps_per_plan() - plan.id;
    log_.update(contact.due, contact.step, plan.id,
                contact.world_time + contact.track_time + contact.hand_time + contact.contact_time +
                    plan.plan_time + plan.lift_time,
                1.0 / settings_.world_rate);
    return true;
  }

  bool on_progress(double time) override {
    // wall-clock time, so that a run that stands still is noticed
    const double now = since_start_.seconds();
    if (view_ != nullptr) view_->check();
    counts_.device = pipeline_.device_stats();
    counts_.stalls = pipeline_.emit_stats().stalls;
    counts_.limited = pipeline_.plans().samples().limited();
    const bool is_gone = pipeline_.device().status() == DeviceStatus::Vanished;
    counts_.gone += is_gone && !was_gone_ ? 1 : 0;
    counts_.problem = is_gone ? pipeline_.device().problem() : std::string();
    was_gone_ = is_gone;
    const bool is_hot = pipeline_.device().is_hot();
    counts_.hot += is_hot && !was_hot_ ? 1 : 0;
    was_hot_ = is_hot;
    if (part_ < 0) say_part(now);
    log_.count(now, counts_);
    if (now - looked_ >= kLookAtUse) {
      looked_ = now;
      log_.use(now, machine_use());
      say_dips();
      if (load_ != nullptr) load_->set(log_.is_loaded_at(now));
      say_part(now);
    }
    progress_.show(time, seconds_, "s");
    return !interrupt_.requested();
  }

  /// Ends the output of this observer.
  void end() {
    if (load_ != nullptr) load_->set(false);
    progress_.clear();
    log_.end(std::min(since_start_.seconds(), seconds_), machine_use());
    say_dips();
    tell_part(part_);
  }

 private:
  void say_dips() {
    for (; said_ < log_.dips().size(); ++said_) {
      const SoakDip& dip = log_.dips()[said_];
      if (dip.covered || ++said_of_part_ > kMostSaid) continue;
      progress_.say(out_, fmt::format("{:.2f} s, {}: {}; likely cause: {}", dip.time, dip.what,
                                      dip.count, dip.cause));
    }
  }

  void say_part(double now) {
    const int part = log_.part_at(now);
    if (part == part_) return;
    if (part_ >= 0) tell_part(part_);
    part_ = part;
    said_of_part_ = 0;
    const SoakPart& of = log_.parts()[static_cast<std::size_t>(part)];
    progress_.say(out_, fmt::format("{:.0f} s: the {}, begins", now, name_of_part(part, of)));
  }

  void tell_part(int part) {
    const SoakPart& of = log_.parts()[static_cast<std::size_t>(std::max(part, 0))];
    progress_.say(out_,
                  fmt::format("  {} dips, {} late blocks absorbed by the queue; smoke {:.1f} Hz, "
                              "plans {:.1f} Hz",
                              of.dips, of.covered, of.world_rate, of.plan_rate));
  }

  SoakLog& log_;
  Pipeline& pipeline_;
  const PipelineSettings& settings_;
  const double seconds_;
  CoreLoad* load_;
  const View* view_;
  const Interrupt& interrupt_;
  std::FILE* out_;
  const StageTimer since_start_;
  SoakCounts counts_;
  double looked_ = 0.0;  // at the machine [s]
  int part_ = -1;
  bool was_hot_ = false, was_gone_ = false;
  std::size_t said_ = 0;
  std::int64_t said_of_part_ = 0;
  Progress progress_{"soaking"};
};

nlohmann::ordered_json parts_json(const SoakLog& log) {
  nlohmann::ordered_json parts = nlohmann::ordered_json::array();
  for (const SoakPart& part : log.parts()) {
    parts.push_back({{"loaded", part.loaded},
                     {"from_s", part.from},
                     {"to_s", part.to},
                     {"dips", part.dips},
                     {"covered", part.covered},
                     {"world_rate_hz", part.world_rate},
                     {"plan_rate_hz", part.plan_rate}});
  }
  return parts;
}

nlohmann::ordered_json dips_json(const SoakLog& log) {
  nlohmann::ordered_json dips = nlohmann::ordered_json::array();
  for (const SoakDip& dip : log.dips()) {
    dips.push_back({{"time_s", dip.time},
                    {"part", dip.part},
                    {"what", dip.what},
                    {"count", dip.count},
                    {"covered", dip.covered},
                    {"cause", dip.cause}});
  }
  return dips;
}

/// The result in one sentence.
std::string judged(const SoakLog& log, bool stopped) {
  std::int64_t quiet = 0, loaded = 0, covered = 0;
  for (const SoakPart& part : log.parts()) {
    (part.loaded ? loaded : quiet) += part.dips;
    covered += part.covered;
  }
  return fmt::format(
      "{}{} dips while the machine was quiet, {} under load; {} late blocks were absorbed by the "
      "queue, so they were not felt.",
      stopped ? "Cut short: " : "", quiet, loaded, covered);
}

/// Prints once what the system allows.
nlohmann::ordered_json tell_limits(bool locks, std::FILE* out) {
  const bool priority = realtime_limits().priority, locked = locks && lock_memory();
  fmt::print(out, "{}\n", priority_sentence(priority));
  if (locks) fmt::print(out, "{}\n", locked ? "All memory is locked." : memory_sentence(false));
  std::fflush(out);
  return {{"realtime_priority", priority}, {"locked_memory", locked}};
}

double seconds_of(const SoakOptionsGiven& given) {
  if (given.minutes >= 0.05 && given.minutes <= 1440.0) return 60.0 * given.minutes;
  throw InputError(fmt::format("--minutes {} must be from 0.05 to 1440", given.minutes));
}

}  // namespace

int soak_command(const SoakOptionsGiven& given) {
  const RunOptionsGiven& of_run = given.run;
  std::FILE* out = prose(of_run.common.json);
  RunOptions options;
  options.seconds = seconds_of(given);
  PipelineSettings settings = make_settings(of_run.common, of_run.scene, true);
  settle_hand(of_run.hand, of_run.hand_size, settings);
  check_view(of_run, true);
  const Interrupt interrupt;
  // before the first thread
  const auto load = given.load ? std::make_unique<CoreLoad>() : nullptr;
  nlohmann::ordered_json json = {{"format", "prostm-soak/1"}};
  const nlohmann::ordered_json limits = tell_limits(of_run.lock_memory, out);
  if (!of_run.common.budget_ms) set_live_budget(settings);
  auto hands = make_hands(of_run.hand, settings);
  std::unique_ptr<View> view;
  if (of_run.view) {
    view = std::make_unique<View>(of_run, settings);
    settings = view->settings();
    hands = view->behind_the_page(std::move(hands));
    options.live = &view->link();
  }
  const auto mute = view ? view->link().mute : std::make_shared<Mute>();
  Pipeline pipeline(settings, std::move(hands), mute);
  if (view) view->serve(pipeline, out);

  const int cores = usable_cores();
  SoakLog log(options.seconds, given.load, cores);
  SoakObserver observer(log, pipeline, settings, options.seconds, load.get(), view.get(), interrupt,
                        out);
  const RunSummary summary = run(pipeline, settings, options, observer);
  observer.end();
  const int failed = summary.failure ? tell(summary.failure) : 0;
  const bool passed = failed == 0 && !interrupt.requested() && log.is_quiet_clean();
  const std::string sentence = judged(log, interrupt.requested());
  fmt::print(out, "{}\n", sentence);
  const auto tracker = pipeline.world_stage().hands().tracker_status();
  json.update({{"passed", passed},
               {"stopped", interrupt.requested()},
               {"sentence", sentence},
               {"minutes", summary.seconds / 60.0},
               {"cores", cores},
               {"parts", parts_json(log)},
               {"dips", dips_json(log)},
               {"dips_left_out", log.left_out()}});
  json.update(limits);
  const HandReading* const reading = pipeline.world_stage().hands().reading();
  json["run"] = summary_json(summary, settings, verdict_of(summary, settings, tracker, reading));
  json["settings"] = settings_to_json(settings_groups(settings));
  write_json(of_run.common.json, json);
  say_written(out, of_run.common.json);
  if (failed != 0) return failed;
  if (interrupt.requested()) return interrupt.status();
  return passed ? 0 : kDipped;
}

}  // namespace prostm::app
