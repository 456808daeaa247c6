/// The scenes on a flat closed hand: the figures of the paper's Fig. 3, and the same
/// force by all.

#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <string>

#include "prostm/pipeline/pipeline.hpp"
#include "prostm/stimulus/stimulus_gate.hpp"

namespace prostm {
namespace {

struct Held {
  std::string scene;
  StudyHandSettings hand;
};
void PrintTo(const Held& held, std::ostream* out) {
  *out << held.scene << ", size " << held.hand.size
       << (held.hand.side == Side::Left ? ", left" : ", right");
}

class Scenes : public ::testing::TestWithParam<Held> {};

TEST_P(Scenes, PassTheGateOfAStudy) {
  const Held& held = GetParam();
  PipelineSettings settings;
  settings.scene = held.scene;
  settings.jets.place = JetPlace::Hand;
  WorldStage stage(settings, make_study_hand(held.hand));
  const Scene& scene = scene_from_name(held.scene);
  StimulusGate gate(25, stage.max_cells());
  GateResult result;
  double largest = 0.0;
  for (int step = 1; step <= 300; ++step) {
    WorldFrame frame;
    stage.run(step, 0.02 * step, 0.02, frame);
    if (!frame.targeted) continue;
    result = gate.judge(frame.hands, frame.target, *frame.stimulus);
    if (step > 250) largest = std::max(largest, result.shape.largest);
  }
  EXPECT_TRUE(result.pass) << sentence(result);
  EXPECT_LT(largest, scene.full_scale_pressure);
  EXPECT_GT(largest, 0.5 * scene.full_scale_pressure);
}

INSTANTIATE_TEST_SUITE_P(Hands, Scenes,
                         ::testing::Values(Held{"one-plume", {}}, Held{"two-plumes", {}},
                                           Held{"three-plumes", {}}, Held{"four-plumes", {}},
                                           Held{"four-plumes", {.side = Side::Left}},
                                           Held{"four-plumes", {.size = 0.9}},
                                           Held{"four-plumes", {.size = 1.1}},
                                           Held{"one-plume", {.size = 1.1}}));

// so that strength does not tell them apart
TEST(SceneList, OneAndFourPlumesHaveTheSameFullScale) {
  EXPECT_EQ(scene_from_name("one-plume").full_scale_pressure,
            scene_from_name("four-plumes").full_scale_pressure);
}

}  // namespace
}  // namespace prostm
