/// The box that follows the hand.

#include "prostm/pipeline/smoke/box_follow.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "prostm/core/random.hpp"
#include "prostm/pipeline/pipeline.hpp"
#include "support/heap_guard.hpp"

namespace prostm {
namespace {

GridShape box(double edge) {
  constexpr int kCells = 64;
  return {kCells, kCells, kCells, edge / kCells, Vec3(-0.5 * edge, -0.5 * edge, 0.0)};
}

HandFrame hand_at(const Vec3& p) {
  HandFrame frame;
  frame.hands.emplace_back();
  for (Vec3& joint : frame.hands.front().position) joint = p;
  return frame;
}

GridShape moved(GridShape grid, const CellShift& by) {
  grid.p_DF += grid.cell * Vec3(by[0], by[1], by[2]);
  return grid;
}

TEST(BoxFollower, KeepsThePointInTheMiddle) {
  Random random(11);
  for (int n = 0; n < 20'000; ++n) {
    const GridShape home = box(random.uniform(0.12, 0.4));
    const double edge = home.cell * home.nx, slack = BoxFollower::kSlack * edge;
    const BoxFollower follower({BoxFollows::Palm}, home);
    const Vec3 p(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(0.0, 0.5));
    const GridShape now = moved(home, follower.shift(hand_at(p), home));
    const Vec3 middle = now.p_DF + Vec3(0.5, 0.5, 0.0) * edge;
    ASSERT_LE((middle - p).head<2>().cwiseAbs().maxCoeff(), slack + home.cell);
    const double floor = std::clamp(p.z() - edge * 2.0 / 3.0, 0.0, BoxFollower::kHighestFloor);
    ASSERT_NEAR(now.p_DF.z(), floor, slack + home.cell);
    ASSERT_GE(now.p_DF.z(), -1e-12);
    // the box stays there, even while the hand trembles
    ASSERT_EQ(follower.shift(hand_at(p), now), CellShift{});
  }
}

// trackers may list two hands in either order
TEST(BoxFollower, FollowsTheNearestOfTwoHands) {
  const GridShape home = box(0.2);
  const BoxFollower follower({BoxFollows::Palm}, home);
  const HandFrame left = hand_at(Vec3(-0.15, 0.0, 0.2)), right = hand_at(Vec3(0.05, 0.0, 0.2));
  HandFrame both = left, swapped = right;
  both.hands.push_back(right.hands.front());
  swapped.hands.push_back(left.hands.front());
  EXPECT_EQ(follower.shift(both, home), follower.shift(right, home));
  EXPECT_EQ(follower.shift(swapped, home), follower.shift(right, home));
}

TEST(BoxFollower, StaysWithoutATarget) {
  const GridShape home = box(0.2);
  const BoxFollower follower({BoxFollows::Index}, home);
  EXPECT_EQ(follower.shift({}, home), CellShift{});
  EXPECT_EQ(follower.shift(hand_at(Vec3::Constant(std::numeric_limits<double>::infinity())), home),
            CellShift{});
  const CellShift far = follower.shift(hand_at(Vec3(1e300, 0.0, 0.1)), home);
  EXPECT_LE(far[0] * home.cell, 10.0);
  // a box that follows nothing returns to its home position
  const BoxFollower nobody({}, home);
  EXPECT_EQ(nobody.shift(hand_at(Vec3(0.2, 0, 0.3)), home), CellShift{});
  EXPECT_EQ(nobody.shift({}, moved(home, {3, -2, 1})), (CellShift{-3, 2, -1}));
}

/// A flat hand that swings back and forth, faster than a person's in a study.
class Swinging final : public HandSource {
 public:
  void sample(double time, HandFrame& out) override {
    study_->sample(time, out);
    const double phase = 2.0 * kPi * 0.5 * time;
    for (Hand& hand : out.hands) {
      for (Vec3& p : hand.position) p += Vec3(0.1 * std::sin(phase), 0.05 * std::sin(2 * phase), 0);
      hand.velocity.fill(Vec3(0.1 * kPi * std::cos(phase), 0.1 * kPi * std::cos(2 * phase), 0));
    }
  }

 private:
  std::unique_ptr<HandSource> study_ = make_study_hand({});
};

TEST(BoxFollower, MovesTheWholePipeline) {
  PipelineSettings settings;
  settings.scene = "four-plumes";
  settings.fluid.cells = 32;
  settings.fluid.width = 0.256;
  settings.box.follow = BoxFollows::Palm;
  settings.fluid_pressure.time_constant = 0.05;
  WorldStage stage(settings, std::make_unique<Swinging>());
  WorldFrame frame;
  Vec3 lowest = Vec3::Constant(1.0), highest = Vec3::Constant(-1.0);
  std::int64_t outside = 0, targets = 0;
  double most = 0.0;
  for (int step = 1; step <= 300; ++step) {
    if (step < 50) {
      stage.run(step, 0.02 * step, 0.02, frame);
    } else {
      const test::HeapGuard guard;
      stage.run(step, 0.02 * step, 0.02, frame);
      ASSERT_EQ(guard.allocations(), 0U);
    }
    lowest = lowest.cwiseMin(stage.world().grid().p_DF);
    highest = highest.cwiseMax(stage.world().grid().p_DF);
    if (!frame.targeted || step < 10) continue;
    ++targets;
    outside += frame.contact_stats.joints_outside;
    for (const TargetField& patch : frame.target.patches)
      most = std::max(most, max_pressure(patch));
    EXPECT_FALSE(stage.world_stats().reset);
  }
  EXPECT_GT((highest - lowest).x(), 0.15);
  EXPECT_EQ(outside, 0) << "of the joints of " << targets << " targets";
  EXPECT_GT(most, 0.02);
}

}  // namespace
}  // namespace prostm
