#include "prostm/pipeline/smoke/scene_grids.hpp"

#include <algorithm>
#include <array>

#include "prostm/pipeline/smoke/scene.hpp"
#include "prostm/pipeline/smoke/smoke_world.hpp"

namespace prostm {
namespace {

// coarsest first; multiples of 8 can be halved three times in a V-cycle
constexpr std::array<int, 5> kGrids = {32, 40, 48, 56, 64};

struct SceneShares {
  std::string_view scene;
  std::array<double, kGrids.size()> share;
};
// passed_updates / judged_updates of
//   prostm run --scene SCENE --grid CELLS --hand study --seconds 30 --stepped
// Updates of the first two seconds, while the air rises to the hand, do not pass.
constexpr std::array<SceneShares, 4> kShares = {{
    {"one-plume", {0.91, 0.00, 0.92, 0.92, 0.92}},
    {"two-plumes", {0.01, 0.00, 0.95, 0.95, 0.95}},
    {"three-plumes", {0.00, 0.00, 0.93, 0.93, 0.93}},
    {"four-plumes", {0.00, 0.00, 0.02, 0.91, 0.89}},
}};

bool has_stimulus(std::string_view scene) {
  return scene_from_name(scene).stimulus.maxima > 0;
}

/// Whether all settings that affect the stimulus, except the grid, have their values of the
/// measurement.
bool is_as_measured(const PipelineSettings& settings) {
  const PipelineSettings defaults;
  FluidSettings fluid = settings.fluid;
  fluid.cells = defaults.fluid.cells;
  JetSettings jets = settings.jets;
  jets.place = defaults.jets.place;
  FluidPressureSettings pressure = settings.fluid_pressure;
  pressure.parts = defaults.fluid_pressure.parts;  // does not affect the pressure that is felt
  const StudyHandSettings &hand = settings.study_hand, &usual = defaults.study_hand;
  return fluid == defaults.fluid && jets == defaults.jets && settings.box == defaults.box &&
         pressure == defaults.fluid_pressure && settings.contact == defaults.contact &&
         settings.world_rate == defaults.world_rate &&
         settings.world_steps_per_plan == defaults.world_steps_per_plan &&
         hand.height == usual.height && hand.size == usual.size;
}

}  // namespace

std::optional<double> stimulus_share(std::string_view scene, int cells) {
  const auto grid = std::ranges::find(kGrids, cells);
  const auto of_scene = std::ranges::find(kShares, scene, &SceneShares::scene);
  if (grid == kGrids.end() || of_scene == kShares.end()) return {};
  return of_scene->share[static_cast<std::size_t>(grid - kGrids.begin())];
}

GridEffect grid_effect(const PipelineSettings& settings, int cells) {
  if (!is_smoke(settings)) return GridEffect::Unknown;
  if (!has_stimulus(settings.scene)) return GridEffect::Keeps;
  const std::optional<double> share = stimulus_share(settings.scene, cells);
  if (!share || !is_as_measured(settings)) return GridEffect::Unknown;
  return *share >= kKeptShare ? GridEffect::Keeps : GridEffect::Loses;
}

std::vector<int> coarser_grids(std::string_view scene, int cells) {
  const bool all = !has_stimulus(scene);
  std::vector<int> grids;
  for (std::size_t i = kGrids.size(); i-- > 0;) {
    const bool keeps = all || stimulus_share(scene, kGrids[i]).value_or(0.0) >= kKeptShare;
    if (keeps && kGrids[i] < cells) grids.push_back(kGrids[i]);
  }
  return grids;
}

int finer_grid(std::string_view scene, int cells) {
  for (const int grid : kGrids)
    if (grid > cells && stimulus_share(scene, grid).value_or(0.0) >= kKeptShare) return grid;
  return kGrids.back();
}

}  // namespace prostm
