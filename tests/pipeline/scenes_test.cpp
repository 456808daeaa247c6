/// The scenes on a flat closed hand: the figures of the paper's Fig. 3, all with the same
/// force.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "prostm/core/units.hpp"
#include "prostm/pipeline/pipeline.hpp"
#include "prostm/pipeline/smoke/scene.hpp"
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

/// Targets of the study hand, once the air has settled.
std::vector<TargetFrame> targets_of(const std::string& scene, double settle, double seconds) {
  PipelineSettings settings;
  settings.scene = scene;
  settings.jets.place = JetPlace::Hand;
  WorldStage stage(settings, make_study_hand({}));
  std::vector<TargetFrame> targets;
  const int steps = static_cast<int>(std::lround((settle + seconds) / 0.02));
  for (int step = 1; step <= steps; ++step) {
    WorldFrame frame;
    stage.run(step, 0.02 * step, 0.02, frame);
    if (frame.targeted && 0.02 * step > settle) targets.push_back(frame.target);
  }
  return targets;
}

/// The largest pressure within `radius` of a point above the palm joint of the study hand.
double most_around(const TargetField& patch, const Vec2& p_D, double radius) {
  double most = 0.0;
  for (std::size_t cell = 0; cell < patch.size(); ++cell) {
    const Vec2 x = patch.position(cell);
    if (((patch.X_DP * Vec3(x.x(), x.y(), 0.0)).head<2>() - p_D).norm() < radius)
      most = std::max(most, patch.pressure[cell]);
  }
  return most;
}

TEST(SceneList, TheRingIsOpenInItsMiddle) {
  const TargetFrame target = targets_of("ring", 6.0, 0.04).front();
  const TargetField& patch = target.patches.front();
  const Vec2 middle(0.0, 0.008);
  const double inside = most_around(patch, middle, 0.012);
  EXPECT_GT(inside, 0.0);
  for (int n = 0; n < 6; ++n) {
    const double angle = kPi / 3.0 * n;
    const Vec2 jet = middle + 0.035 * Vec2(std::cos(angle), std::sin(angle));
    EXPECT_LT(inside, 0.7 * most_around(patch, jet, 0.010)) << "jet " << n;
  }
}

TEST(SceneList, SomeSwellAndFall) {
  for (const auto& [scene, period] : {std::pair("pulsing", 25), std::pair("wind", 63)}) {
    std::vector<double> force;
    for (const TargetFrame& target : targets_of(scene, 3.0, 5.2))
      force.push_back(total_pressure(target.patches.front()));
    const auto [least, most] = std::minmax_element(force.begin(), force.end());
    EXPECT_GT(*most, 1.5 * *least) << scene;
    const auto n = static_cast<std::size_t>(period);
    for (std::size_t i = 0; i + n < force.size(); ++i)
      EXPECT_NEAR(force[i + n], force[i], 0.2 * *most) << scene << ", update " << i;
  }
}

// so that their strengths do not distinguish them
TEST(SceneList, OneAndFourPlumesHaveTheSameFullScale) {
  EXPECT_EQ(scene_from_name("one-plume").full_scale_pressure,
            scene_from_name("four-plumes").full_scale_pressure);
}

}  // namespace
}  // namespace prostm
