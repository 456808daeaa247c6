#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common.hpp"
#include "prostm/core/stage_timer.hpp"
#include "prostm/io/quantity_json.hpp"
#include "prostm/pipeline/realtime/machine.hpp"
#include "prostm/pipeline/realtime/machine_check.hpp"
#include "prostm/pipeline/smoke/scene.hpp"

namespace prostm::app {
namespace {

constexpr double kAll = 18.5;                      // time limit of the whole command [s]
constexpr double kLongest = 5.0, kShortest = 2.0;  // durations of a trial [s]
constexpr double kLeastLook = 1.5;                 // least time before a trial is given up [s]
constexpr double kSleeps = 1.0;                    // time for measuring how late sleeps end [s]
constexpr int kDoesNotHold = 1;                    // exit status

/// Ends a trial as soon as it is certain to miss its rates.
class Watch final : public RunObserver {
 public:
  Watch(Pipeline& pipeline, const PipelineSettings& settings, double seconds, Progress& progress,
        const Interrupt& interrupt)
      : pipeline_(pipeline),
        settings_(settings),
        seconds_(seconds),
        progress_(progress),
        interrupt_(interrupt) {}

  bool on_plan(const WorldFrame& contact, const PlanFrame&) override {
    const double rate = settings_.world_rate;
    summary_.skipped_world_steps = std::llround(contact.due * rate) - contact.step;
    summary_.world_steps = std::llround(seconds_ * rate) - summary_.skipped_world_steps;
    return true;
  }
  bool on_progress(double time) override {
    progress_.show(time, seconds_, "s");
    return (time < kLeastLook || may_hold()) && !interrupt_.requested();
  }

 private:
  /// Whether the trial holds if nothing more goes wrong.
  bool may_hold() {
    const DeviceInfo& device = pipeline_.device().info();
    summary_.device = pipeline_.device_stats();
    summary_.device.blocks = std::llround(seconds_ * device.sample_rate / device.block_samples);
    return world_rate(summary_, settings_).held() && samples_held(summary_);
  }

  Pipeline& pipeline_;
  const PipelineSettings& settings_;
  const double seconds_;
  Progress& progress_;
  const Interrupt& interrupt_;
  RunSummary summary_;  // the best possible one at the end
};

MachineTrial make_trial(const CheckedSetup& setup, const std::optional<std::string>& scene,
                        double seconds, const Interrupt& interrupt) {
  PipelineSettings settings = make_settings({}, scene, true);
  settings.scripted_hand.still = true;  // always there
  settings.fluid.cells = setup.cells;
  settings.plan.preset = setup.preset;
  set_live_budget(settings);
  Pipeline pipeline(settings, make_hands("scripted", settings));
  Progress progress(options_of(setup));
  Watch watch(pipeline, settings, seconds, progress, interrupt);
  RunOptions options;
  options.seconds = seconds;
  MachineTrial trial{setup, run(pipeline, settings, options, watch), {}};
  if (trial.summary.failure) std::rethrow_exception(trial.summary.failure);
  trial.verdict = verdict_of(trial.summary, settings);
  return trial;
}

/// Makes trials from the defaults to the cheapest setup, until one holds or the time is up.
std::vector<MachineTrial> make_trials(std::FILE* out, const std::optional<std::string>& scene,
                                      std::span<const CheckedSetup> setups,
                                      const StageTimer& since_start, const Interrupt& interrupt) {
  std::vector<MachineTrial> trials;
  for (std::size_t i = 0; i < setups.size(); ++i) {
    const double left = kAll - since_start.seconds();
    const double seconds =
        std::clamp(left / static_cast<double>(setups.size() - i), kShortest, kLongest);
    if (seconds > left) break;
    MachineTrial trial = make_trial(setups[i], scene, seconds, interrupt);
    if (interrupt.requested()) break;
    fmt::print(out, "{}: {}, {}{}\n", options_of(setups[i]), trial.holds() ? "held" : "not held",
               rates_text(trial.summary, {}),
               samples_held(trial.summary) ? "" : ", and the array missed blocks");
    std::fflush(out);
    trials.push_back(std::move(trial));
    if (trials.back().holds()) break;
  }
  return trials;
}

void print_machine(std::FILE* out, const Machine& m) {
  fmt::print(out, "{} core{} of {}; vectors: {}\n", m.cores, m.cores == 1 ? "" : "s",
             m.cpu.empty() ? "an unknown processor" : m.cpu, m.vectors);
  fmt::print(
      out, "real-time priority for the array's thread: {}\n",
      m.realtime_priority ? "granted" : "not granted (ulimit -r 10 allows it; nothing needs it)");
  fmt::print(out,
             "after a sleep of 1 ms it wakes {:.2f} ms late at the 99th percentile, {:.2f} ms "
             "at most\n",
             1e3 * m.sleep_late.p99, 1e3 * m.sleep_late.max);
  std::fflush(out);
}

nlohmann::ordered_json trial_json(const MachineTrial& trial) {
  const RunSummary& s = trial.summary;
  return {{"grid", trial.setup.cells},
          {"preset", name_of(trial.setup.preset)},
          {"held", trial.holds()},
          {"seconds", s.seconds},
          {"world_rate_hz", world_rate(s, {}).done},
          {"plan_rate_hz", plan_rate(s, {}).done},
          {"missed_blocks", s.device.missed_blocks},
          {"world_ms", to_json(s.world, 1e3)},
          {"plan_ms", to_json(s.plan, 1e3)}};
}

nlohmann::ordered_json setup_json(const std::optional<CheckedSetup>& setup) {
  if (!setup) return nullptr;
  return {{"grid", setup->cells}, {"preset", name_of(setup->preset)}};
}

nlohmann::ordered_json check_json(const Machine& m, const std::vector<MachineTrial>& trials,
                                  const MachineAnswer& answer) {
  nlohmann::ordered_json scenes = nlohmann::ordered_json::object();
  for (const SceneAnswer& of : answer.scenes) scenes[of.scene] = setup_json(of.use);
  nlohmann::ordered_json tried = nlohmann::ordered_json::array();
  for (const MachineTrial& trial : trials) tried.push_back(trial_json(trial));
  return {{"format", "prostm-check/1"},
          {"defaults_hold", answer.defaults_hold},
          {"use", setup_json(answer.use)},
          {"scenes", scenes},
          {"sentences", answer.sentences},
          {"cpu", m.cpu},
          {"cores", m.cores},
          {"vectors", m.vectors},
          {"realtime_priority", m.realtime_priority},
          {"sleep_late_ms", to_json(m.sleep_late, 1e3)},
          {"trials", tried}};
}

}  // namespace

int check_command(const CheckOptionsGiven& given) {
  const StageTimer since_start;
  const Interrupt interrupt;
  std::FILE* out = prose(given.json);
  const std::vector<std::string> scenes =
      given.scene ? std::vector{std::string(scene_from_name(*given.scene).name)}
                  : stimulus_scenes();
  const std::vector<CheckedSetup> setups = checked_setups(scenes);
  const Machine machine = look_at_machine(kSleeps);
  print_machine(out, machine);
  const std::vector<MachineTrial> trials =
      make_trials(out, given.scene, setups, since_start, interrupt);
  if (interrupt.requested()) {
    fmt::print(out, "Stopped before the answer was known.\n");
    return interrupt.status();
  }
  const MachineAnswer answer = answer_of(trials, scenes);
  for (const std::string& sentence : answer.sentences) fmt::print(out, "{}\n", sentence);
  write_json(given.json, check_json(machine, trials, answer));
  say_written(out, given.json);
  return answer.defaults_hold ? 0 : kDoesNotHold;
}

}  // namespace prostm::app
