/// Evaluation of the felt field over live runs.

#include <gtest/gtest.h>

#include <cmath>

#include "felt/live.hpp"
#include "prostm/core/units.hpp"
#include "prostm/fields/felt_fields.hpp"

namespace prostm::bench {
namespace {

TargetField target() {
  return fields::felt_field(fields::FeltKind::BlobPair, 1, fields::Outline::Palm);
}

/// A circle that takes 10 ms.
Plan circle(const Vec2& middle) {
  constexpr int kPoints = 16;
  Plan plan;
  FocalPath& path = plan.paths.emplace_back();
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 2.0 * kPi * i / kPoints;
    path.points.emplace_back(middle + 0.011 * Vec2(std::cos(angle), std::sin(angle)));
    path.pressure.push_back(1.0 + 0.3 * std::sin(angle));
  }
  path.length = closed_length(path);
  path.speed = 7.0;
  return in_step(plan, target(), 0.010);
}

/// Plans the same circle every time.
Way steady() {
  return {"steady", [](const TargetField&) -> Planning {
            return [](const TargetField&) { return circle(Vec2::Zero()); };
          }};
}

/// Plans the same circle first, then circles to the left and right in turn.
Way wandering() {
  return {"wandering", [](const TargetField&) -> Planning {
            return [count = 0](const TargetField&) mutable {
              const int turn = count++;
              return circle(turn == 0 ? Vec2::Zero() : Vec2(turn % 2 == 0 ? 0.03 : -0.03, 0.0));
            };
          }};
}

TEST(FeltLab, AConstantRunIsFeltLikeItsLoop) {
  const LiveSequence still{"still", std::vector<TargetField>(12, target())};
  const LiveSet set =
      score_live("test", usx_array(), {still}, {steady(), wandering()}, SwitchAt::Lap, 2);
  const LiveScores own = set.scores[0][0], other = set.scores[1][0];
  EXPECT_EQ(own.alone, own.loop);
  EXPECT_NEAR(own.live, own.loop, 0.01);
  EXPECT_NEAR(own.window, own.live, 0.01);
  EXPECT_GT(own.intensity, 0.0);
  EXPECT_EQ(other.alone, own.alone) << "planned with a separate planner";
  EXPECT_NE(other.loop, own.loop);
  EXPECT_GT(other.faded, own.faded);
}

TEST(FeltLab, SequencesMoveUnlessTheyAreHeld) {
  const auto moving = live_sequences(false), still = live_sequences(true, 2);
  ASSERT_EQ(moving.size(), 5u);
  ASSERT_EQ(still.size(), 2u);
  for (const LiveSequence& sequence : moving) {
    for (std::size_t i = 1; i < sequence.targets.size(); ++i)
      EXPECT_NE(sequence.targets[i].pressure, sequence.targets[i - 1].pressure) << sequence.name;
  }
  for (const TargetField& target : still[1].targets)
    EXPECT_EQ(target.pressure, moving[1].targets[0].pressure);
}

TEST(FeltLab, APlannerContinuesFromThePreviousPlan) {
  const auto sequence = live_sequences(false, 1).front();
  for (const Way& way : ways(usx_array())) {
    if (way.name != "best") continue;
    const Planning planning = way.begin(sequence.targets[0]);
    planning(sequence.targets[0]);
    const Plan warm = planning(sequence.targets[1]), cold = way.plan(sequence.targets[1]);
    EXPECT_NE(warm.paths[0].points, cold.paths[0].points);
    EXPECT_EQ(way.plan(sequence.targets[1]).paths[0].points, cold.paths[0].points);
  }
}

TEST(FeltLab, CountsHastyChangesUnlessRegionsChange) {
  TargetField one;
  one.resize(3, 9);
  one.skin.assign(one.size(), 1);
  one.pressure[one.index(1, 1)] = 100.0;
  TargetField two = one, faint = one;
  two.pressure[two.index(1, 6)] = 30.0;
  faint.pressure[faint.index(1, 6)] = 20.0;
  const double interval = 0.25;
  EXPECT_EQ(count_hasty({4, 1, 1, 1}, {one, one, one, one}, interval), 0);
  EXPECT_EQ(count_hasty({4, 1, 2, 1}, {one, one, one, one}, interval), 2);
  EXPECT_EQ(count_hasty({4, 1, 2, 2}, {one, one, two, two}, interval), 0);
  EXPECT_EQ(count_hasty({4, 1, 1, 2}, {one, one, two, one}, interval), 0);
  EXPECT_EQ(count_hasty({4, 1, 2, 1}, {one, one, faint, one}, interval), 2);
  EXPECT_EQ(count_hasty({4, 1, 1, 1, 1, 2}, std::vector<TargetField>(6, one), interval), 0);
}

}  // namespace
}  // namespace prostm::bench
