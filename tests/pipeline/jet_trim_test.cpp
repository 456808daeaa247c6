#include "prostm/pipeline/smoke/jet_trim.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "prostm/core/units.hpp"
#include "prostm/pipeline/pipeline.hpp"
#include "prostm/pipeline/smoke/scene.hpp"
#include "prostm/track/palm.hpp"
#include "support/heap_guard.hpp"

namespace prostm {
namespace {

const std::vector<SmokeJet> kJets = {{{-0.02, 0.0}, 0.02, 1.0}, {{0.02, 0.0}, 0.02, 1.0}};

/// A plate 0.2 m above the array, pressed by each jet with its own pressure.
TargetFrame pressed(double left, double right) {
  TargetFrame frame;
  TargetField& field = frame.patches.emplace_back();
  field.cell = 0.01;
  field.origin = Vec2(-0.035, -0.03);
  field.resize(7, 8);
  for (std::size_t c = 0; c < field.size(); ++c) {
    field.skin[c] = 1;
    field.pressure[c] = field.position(c).x() < 0.0 ? left : right;
  }
  return frame;
}

TEST(JetTrim, FollowsItsEquation) {
  JetTrim trim({.trim_rate = 0.3}, 2);
  ASSERT_TRUE(trim.update(pressed(0.08, 0.12), kJets, 0.04));
  const double up = std::exp(0.3 * 0.04 * 0.2), down = std::exp(-0.3 * 0.04 * 0.2);
  const double scale = std::sqrt(2.0 / (up * up + down * down));
  EXPECT_NEAR(trim.gains()[0], scale * up, 1e-12);
  EXPECT_NEAR(trim.gains()[1], scale * down, 1e-12);
}

// pressure is proportional to the square of a jet's speed; here one jet loses a third of it
TEST(JetTrim, EqualisesTheJetsPressures) {
  JetTrim trim({.trim_rate = 0.3}, 2);
  double left = 0.0, right = 0.0;
  for (int step = 0; step < 2000; ++step) {
    left = 0.067 * trim.gains()[0] * trim.gains()[0];
    right = 0.1 * trim.gains()[1] * trim.gains()[1];
    trim.update(pressed(left, right), kJets, 0.02);
  }
  EXPECT_NEAR(left / right, 1.0, 1e-3);
  EXPECT_NEAR(trim.gains()[0] * trim.gains()[0] + trim.gains()[1] * trim.gains()[1], 2.0, 1e-9);
}

TEST(JetTrim, GainsStayWithinTheirLimit) {
  JetTrim trim({.trim_rate = 2.0, .trim_limit = 0.2}, 2);
  for (int step = 0; step < 500; ++step) trim.update(pressed(0.001, 0.1), kJets, 0.02);
  EXPECT_NEAR(trim.gains()[0] / trim.gains()[1], 1.2 / 0.8, 1e-9);
}

TEST(JetTrim, HoldsItsGainsUnlessEveryJetPressesOnSkin) {
  JetTrim trim({.trim_rate = 0.3}, 2);
  EXPECT_FALSE(trim.update({}, kJets, 0.02));
  EXPECT_FALSE(trim.update(pressed(0.0, 0.1), kJets, 0.02));
  EXPECT_EQ(trim.gains()[0], 1.0);
  JetTrim never({.trim_rate = 0.0}, 2);
  EXPECT_FALSE(never.update(pressed(0.05, 0.1), kJets, 0.02));
}

TEST(ScenePlace, MovesRotatesAndScalesTheJets) {
  const ScenePlace place{Vec2(0.05, -0.01), 0.5 * kPi, 1.2};
  SmokeInflow inflow;
  inflow.jets = {{Vec2(0.0, 0.02), 0.03, 0.7}};
  SmokeInflow moved = inflow;
  const test::HeapGuard guard;
  move_to(place, inflow, moved);
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_LT((moved.jets[0].centre - Vec2(0.05 - 0.024, -0.01)).norm(), 1e-9);
  EXPECT_NEAR(moved.jets[0].radius, 0.036, 1e-12);
  EXPECT_EQ(moved.jets[0].speed, 0.7);
}

/// A study hand held off the middle of the array.
class Aside final : public HandSource {
 public:
  explicit Aside(double x) : x_(x), hand_(make_study_hand({})) {}
  void sample(double time, HandFrame& out) override {
    hand_->sample(time, out);
    for (Vec3& p : out.hands[0].position) p.x() += x_;
  }

 private:
  double x_;
  std::unique_ptr<HandSource> hand_;
};

/// x of the centre of pressure on a hand, in D, after 2 s [m].
double middle_of_pressure(JetPlace place, double x) {
  PipelineSettings settings;
  settings.scene = "two-plumes";
  settings.fluid.cells = 48;
  settings.jets.place = place;
  settings.world_steps_per_plan = 1;
  WorldStage stage(settings, std::make_unique<Aside>(x));
  WorldFrame frame;
  for (int step = 1; step <= 100; ++step) stage.run(step, 0.02 * step, 0.02, frame);
  const TargetField& patch = frame.target.patches.at(0);
  double sum = 0.0, moment = 0.0;
  for (std::size_t c = 0; c < patch.size(); ++c) {
    const Vec2 q = patch.position(c);
    sum += patch.pressure[c];
    moment += patch.pressure[c] * (patch.X_DP * Vec3(q.x(), q.y(), patch.height[c])).x();
  }
  return moment / sum;
}

TEST(ScenePlace, IsKeptWhenAnotherSettingChanges) {
  PipelineSettings settings;
  settings.scene = "one-plume";
  settings.fluid.cells = 32;
  settings.jets.place = JetPlace::Hand;
  WorldStage first(settings, std::make_unique<Aside>(0.04));
  WorldFrame frame;
  for (int step = 1; step <= 4; ++step) first.run(step, 0.02 * step, 0.02, frame);
  settings.fluid.jet_speed = 0.8;
  WorldStage second(settings, nullptr);
  second.adopt(first);
  EXPECT_NEAR(second.world().stimulus()->place.centre.x(), 0.04, 1e-6);
  second.set_hands(std::make_unique<Aside>(0.0));
  for (int step = 5; step <= 8; ++step) second.run(step, 0.02 * step, 0.02, frame);
  EXPECT_NEAR(second.world().stimulus()->place.centre.x(), 0.04, 1e-6);
}

TEST(ScenePlace, ThePressureIsTheSameUnderTheHandAsInTheMiddle) {
  const double middle = middle_of_pressure(JetPlace::Array, 0.0);
  EXPECT_NEAR(middle_of_pressure(JetPlace::Hand, 0.04) - 0.04, middle, 0.003);
  EXPECT_LT(middle_of_pressure(JetPlace::Array, 0.04) - 0.04, middle - 0.005);
}

}  // namespace
}  // namespace prostm
