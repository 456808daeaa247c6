/// The grids that keep a scene's stimulus, compared with the worlds themselves.

#include "prostm/pipeline/smoke/scene_grids.hpp"

#include <gmock/gmock.h>

#include <functional>
#include <string>

#include "prostm/pipeline/pipeline.hpp"
#include "prostm/pipeline/smoke/scene.hpp"

namespace prostm {
namespace {

using testing::ElementsAre;

/// Share of the updates, after the air has settled, in which the study hand gets the stimulus.
double measured_share(const std::string& scene, int cells) {
  PipelineSettings settings;
  settings.scene = scene;
  settings.fluid.cells = cells;
  settings.jets.place = JetPlace::Hand;
  WorldStage stage(settings, make_study_hand({}));
  StimulusGate gate(25, stage.max_cells());
  int updates = 0, passed = 0;
  for (int step = 1; step <= 400; ++step) {
    WorldFrame frame;
    stage.run(step, 0.02 * step, 0.02, frame);
    if (!frame.targeted) continue;
    const bool pass = gate.judge(frame.hands, frame.target, *frame.stimulus).pass;
    if (step <= 250) continue;
    ++updates;
    passed += pass ? 1 : 0;
  }
  return static_cast<double>(passed) / updates;
}

struct Cell {
  const char* scene;
  int cells;
};
class SceneGridsOf : public ::testing::TestWithParam<Cell> {};

TEST_P(SceneGridsOf, TheTableMatchesTheWorld) {
  const auto [scene, cells] = GetParam();
  const bool keeps = *stimulus_share(scene, cells) >= kKeptShare;
  EXPECT_EQ(measured_share(scene, cells) >= kKeptShare, keeps) << scene << " at " << cells;
}

// the options suggested first, and grids that lose the stimulus
INSTANTIATE_TEST_SUITE_P(Cells, SceneGridsOf,
                         ::testing::Values(Cell{"one-plume", 32}, Cell{"one-plume", 40},
                                           Cell{"two-plumes", 48}, Cell{"three-plumes", 40},
                                           Cell{"three-plumes", 48}, Cell{"four-plumes", 48},
                                           Cell{"four-plumes", 56}),
                         [](const auto& cell) {
                           std::string name = cell.param.scene;
                           std::erase(name, '-');
                           return name + std::to_string(cell.param.cells);
                         });

TEST(SceneGrids, CoarserGridsKeepTheStimulus) {
  EXPECT_THAT(coarser_grids("one-plume", 64), ElementsAre(56, 48, 32));
  EXPECT_THAT(coarser_grids("four-plumes", 64), ElementsAre(56));
  EXPECT_THAT(coarser_grids("four-plumes", 56), ElementsAre());
  EXPECT_THAT(coarser_grids("ring", 64), ElementsAre(56, 48, 40, 32)) << "ring has no stimulus";
  EXPECT_THAT(coarser_grids("wind", 100), ElementsAre(64, 56, 48, 40, 32));
  EXPECT_EQ(finer_grid("four-plumes", 32), 56);
  EXPECT_EQ(finer_grid("one-plume", 40), 48);
}

TEST(SceneGrids, EveryStimulusIsInTheTable) {
  for (const Scene& scene : scenes()) {
    const bool known = stimulus_share(scene.name, FluidSettings{}.cells).has_value();
    EXPECT_EQ(known, scene.stimulus.maxima > 0) << scene.name;
    PipelineSettings settings;
    settings.scene = scene.name;
    EXPECT_EQ(grid_effect(settings, FluidSettings{}.cells), GridEffect::Keeps) << scene.name;
  }
}

TEST(SceneGrids, SettingsThatWereNotMeasuredAreUnknown) {
  PipelineSettings settings;
  settings.scene = "four-plumes";
  EXPECT_EQ(grid_effect(settings, 56), GridEffect::Keeps);
  EXPECT_EQ(grid_effect(settings, 48), GridEffect::Loses);
  EXPECT_EQ(grid_effect(settings, 50), GridEffect::Unknown);
  settings.jets.place = JetPlace::Hand;
  settings.fluid_pressure.parts = true;
  settings.plan.preset = Preset::Fast;
  EXPECT_EQ(grid_effect(settings, 56), GridEffect::Keeps) << "none of these affects the target";
  const std::function<void(PipelineSettings&)> changes[] = {
      [](auto& s) { s.fluid.width = 0.3; },
      [](auto& s) { s.fluid.jet_speed = 1.2; },
      [](auto& s) { s.fluid.substeps = 2; },
      [](auto& s) { s.world_rate = 40.0; },
      [](auto& s) { s.jets.trim_rate = 0.0; },
      [](auto& s) { s.study_hand.height = 0.18; },
      [](auto& s) { s.study_hand.size = 0.8; },
      [](auto& s) { s.box.follow = BoxFollows::Palm; },
      [](auto& s) { s.fluid_pressure.offset = 0.004; }};
  for (const auto& change : changes) {
    PipelineSettings changed = settings;
    change(changed);
    EXPECT_EQ(grid_effect(changed, 56), GridEffect::Unknown);
    changed.scene = "ring";
    EXPECT_EQ(grid_effect(changed, 56), GridEffect::Keeps) << "no stimulus is required";
  }
}

}  // namespace
}  // namespace prostm
