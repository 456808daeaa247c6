#include "prostm/pipeline/realtime/machine_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "prostm/pipeline/smoke/scene.hpp"
#include "prostm/pipeline/smoke/scene_grids.hpp"

namespace prostm {
namespace {

constexpr int kDefaultCells = FluidSettings{}.cells;

/// Describes the slack of the stages.
std::string slack(const RunSummary& s) {
  const PipelineSettings settings;
  const double step = 1e3 / settings.world_rate;
  return fmt::format(
      "Slack: a step of the smoke takes {:.1f} ms at the median and {:.1f} ms at the 99th "
      "percentile, of {:.0f}; a plan takes {:.1f} and {:.1f} ms, of {:.0f}.",
      1e3 * s.world.p50, 1e3 * s.world.p99, step, 1e3 * s.plan.p50, 1e3 * s.plan.p99,
      step * settings.steps_per_plan());
}

/// The setup for a scene on a machine that holds its rates with `held` and all coarser grids.
std::optional<CheckedSetup> use_in(const std::string& scene, const CheckedSetup& held) {
  const std::vector<int> grids = coarser_grids(scene, held.cells + 1);
  if (grids.empty()) return {};
  return CheckedSetup{grids.front(), held.preset};
}

bool has_stimulus(const std::string& scene) {
  return scene_from_name(scene).stimulus.maxima > 0;
}

std::string listed(const std::vector<std::string>& names) {
  std::string all;
  for (std::size_t i = 0; i < names.size(); ++i)
    all += (i == 0 ? "" : i + 1 < names.size() ? ", " : " and ") + names[i];
  return all;
}

/// Adds sentences on which setup to use in which scenes, if the defaults do not hold the rates.
void tell_scenes(const MachineAnswer& answer, std::vector<std::string>& out) {
  std::vector<std::string> without, options;
  for (const SceneAnswer& of : answer.scenes) {
    if (!of.use)
      without.push_back(of.scene);
    else if (const std::string text = options_of(*of.use); !std::ranges::count(options, text))
      options.push_back(text);
  }
  for (const std::string& text : options) {
    std::vector<std::string> scenes;
    for (const SceneAnswer& of : answer.scenes)
      if (of.use && options_of(*of.use) == text) scenes.push_back(of.scene);
    const bool stimuli = std::ranges::all_of(scenes, has_stimulus);
    out.push_back(fmt::format("Use {} in {}{}.", text, listed(scenes),
                              stimuli ? ", whose stimulus it keeps" : ""));
  }
  if (without.empty()) return;
  out.push_back(fmt::format(
      "No option holds the rates{} in {}: close other programs and check again, use a faster "
      "machine, or run without a clock (--as-fast-as-possible).",
      std::ranges::all_of(without, has_stimulus) ? " and keeps the stimulus" : "",
      listed(without)));
}

}  // namespace

std::vector<std::string> stimulus_scenes() {
  std::vector<std::string> names;
  for (const Scene& scene : scenes())
    if (has_stimulus(std::string(scene.name))) names.emplace_back(scene.name);
  return names;
}

std::vector<CheckedSetup> checked_setups(std::span<const std::string> scenes) {
  std::vector<int> grids;
  for (const std::string& scene : scenes) {
    const std::vector<int> coarser = coarser_grids(scene, kDefaultCells);
    grids.insert(grids.end(), coarser.begin(), coarser.end());
  }
  std::ranges::sort(grids, std::greater{});
  grids.erase(std::unique(grids.begin(), grids.end()), grids.end());
  std::vector<CheckedSetup> setups = {{kDefaultCells, kDefaultPreset},
                                      {kDefaultCells, kCheapestPreset}};
  for (const int cells : grids) setups.push_back({cells, kDefaultPreset});
  if (!grids.empty()) setups.push_back({grids.back(), kCheapestPreset});
  return setups;
}

std::string options_of(const CheckedSetup& setup) {
  return fmt::format("--grid {} --preset {}", setup.cells, name_of(setup.preset));
}

MachineAnswer answer_of(std::span<const MachineTrial> trials, std::span<const std::string> scenes) {
  MachineAnswer answer;
  if (trials.empty()) {
    answer.sentences.emplace_back("Nothing was tried: the machine was too slow to begin.");
    return answer;
  }
  const MachineTrial &first = trials.front(), &last = trials.back();
  const PipelineSettings settings;
  const std::string rates =
      fmt::format("{:.0f} steps and {:.0f} plans a second", settings.world_rate,
                  settings.world_rate / settings.steps_per_plan());
  answer.defaults_hold = first.holds();
  for (const std::string& scene : scenes) {
    const std::optional<CheckedSetup> use =
        last.holds() ? use_in(scene, last.setup) : std::optional<CheckedSetup>();
    answer.scenes.push_back({scene, use});
  }
  // the last setup is recommended for all scenes only if all keep their stimulus with it
  const auto same = [&](const SceneAnswer& of) {
    return of.use && of.use->cells == answer.scenes.front().use->cells;
  };
  if (!answer.scenes.empty() && answer.scenes.front().use &&
      std::ranges::all_of(answer.scenes, same))
    answer.use = answer.scenes.front().use;
  if (answer.defaults_hold) {
    answer.sentences.push_back(fmt::format("This machine holds {} with the defaults ({}).", rates,
                                           options_of(first.setup)));
  } else {
    answer.sentences.push_back(
        last.holds()
            ? fmt::format("This machine does not hold {} with the defaults, but it does with {}.",
                          rates, options_of(last.setup))
            : fmt::format("This machine does not hold {}, not even with {}.", rates,
                          options_of(last.setup)));
    tell_scenes(answer, answer.sentences);
  }
  if (last.holds()) answer.sentences.push_back(slack(last.summary));
  return answer;
}

}  // namespace prostm
