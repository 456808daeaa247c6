#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "prostm/acoustics/skin/sensation_level.hpp"
#include "prostm/fields/fields.hpp"
#include "prostm/methods/comparison.hpp"
#include "prostm/score/plan_percept.hpp"
#include "support/load.hpp"

namespace prostm::methods {
namespace {

constexpr int kCells = 32;

TargetField target() {
  return fields::make(fields::Pattern::OnePlume, 50, kCells);
}

TEST(Rendering, ControlsEqualiseTheStatedQuantity) {
  const TargetField field = target();
  Renderer renderer(usx_array(), field);
  const Rendering best = renderer.render(Way::Best, field), am = renderer.render(Way::Am, field),
                  flat = renderer.render(Way::Flat, field);
  EXPECT_EQ(factor_for(Equal::Drive, am, best), 1.0);
  EXPECT_EQ(factor_for(Equal::Drive, flat, best), 0.0);
  EXPECT_EQ(factor_for(Equal::Power, flat, best), 0.0);
  EXPECT_DOUBLE_EQ(factor_for(Equal::Power, am, best) * am.mean_power, best.mean_power);
  for (const Rendering* r : {&best, &am, &flat}) {
    EXPECT_DOUBLE_EQ(factor_for(Equal::Percept, *r, best) * r->felt.largest, best.felt.largest);
    EXPECT_DOUBLE_EQ(factor_for(Equal::Percept, best, best), 1.0);
  }
  // no percept off the skin
  for (std::size_t c = 0; c < field.size(); ++c) {
    if (field.skin[c] == 0) {
      EXPECT_EQ(best.felt.percept[c], 0.0);
    }
  }
}

/// `prostm plan`, `prostm field`, runs and pages give the numbers of plan_percept().
TEST(Rendering, ShapeAndStrengthAreThoseOfEveryCommand) {
  TargetFrame frame;
  frame.patches.push_back(target());
  Renderer renderer(usx_array(), frame.patches[0]);
  WorkerPool pool(1);
  for (const Way way : {Way::PaperValid, Way::Best, Way::Felt, Way::Am}) {
    SCOPED_TRACE(to_string(way));
    const Rendering r = renderer.render(way, frame.patches[0]);
    const PlanPercept percept = plan_percept(r.plan, frame, 0, {}, 40e3, usx_array(), pool);
    EXPECT_DOUBLE_EQ(r.of_felt.skill_8, percept.skill);
    EXPECT_NEAR(sensation_level(r.felt.largest, usx_array()), percept.sensation_level, 0.01);
  }
}

TEST(Rendering, FlatHasNoSkillButBestHas) {
  const TargetField field = target();
  Renderer renderer(usx_array(), field);
  const Rendering flat = renderer.render(Way::Flat, field);
  EXPECT_NEAR(flat.of_envelope.skill_0, 0.0, 1e-9);
  EXPECT_GT(flat.felt.intensity, 0.0);
  const Rendering best = renderer.render(Way::Best, field);
  EXPECT_GT(best.of_envelope.skill_8, 0.5);
  EXPECT_GT(best.mean_power, 1.0);
  EXPECT_LE(best.mean_power, 256.0);
  EXPECT_GT(best.field.largest, best.field.largest_mean);
}

TEST(Rendering, FeltIsTruerAndStrongerThanBestInThePercept) {
  const TargetField field = target();
  Renderer renderer(usx_array(), field);
  const Rendering best = renderer.render(Way::BestNarrow, field),
                  felt = renderer.render(Way::Felt, field);
  EXPECT_GT(felt.of_felt.skill_8, best.of_felt.skill_8);
  EXPECT_GT(felt.felt.largest, best.felt.largest);
  EXPECT_LE(felt.mean_power, 256.0);
}

TEST(Rendering, OneCircleSuitsARingBetterThanOtherCircles) {
  const TargetField ring = fields::make(fields::Pattern::Ring, 50, kCells);
  Renderer renderer(usx_array(), ring);
  const Rendering circle = renderer.render(Way::Circle, ring);
  ASSERT_EQ(circle.plan.paths.size(), 1U);
  EXPECT_GT(circle.of_felt.skill_8, renderer.render(Way::RandomCircles, ring).of_felt.skill_8);
  EXPECT_GT(circle.of_felt.skill_8, renderer.render(Way::Circles, ring).of_felt.skill_8);
}

TEST(Rendering, RandomCirclesDifferInEachCall) {
  const TargetField field = target();
  Renderer renderer(usx_array(), field);
  const Plan one = renderer.render(Way::RandomCircles, field).plan,
             two = renderer.render(Way::RandomCircles, field).plan;
  EXPECT_NE(one.paths[0].points[0], two.paths[0].points[0]);
}

TEST(Rendering, FeltFociAreDelayed) {
  const TargetField field = target();
  Renderer renderer(usx_array(), field);
  const Rendering usual = renderer.render(Way::Am, field),
                  felt = renderer.render(Way::AmFelt, field);
  EXPECT_TRUE(std::ranges::any_of(felt.plan.foci, [](const auto& f) { return f.phase > 0.0; }));
  EXPECT_TRUE(std::ranges::all_of(usual.plan.foci, [](const auto& f) { return f.phase == 0.0; }));
}

TEST(Rendering, FeltFociAreAsManyAsSuitTheTarget) {
  const auto foci_on = [](fields::Pattern pattern) {
    const TargetField field = fields::make(pattern, 50, kCells);
    Renderer renderer(usx_array(), field);
    return renderer.render(Way::AmFelt, field).plan.foci.size();
  };
  EXPECT_EQ(foci_on(fields::Pattern::Palm), 1U) << "one focus is strongest";
  EXPECT_GE(foci_on(fields::Pattern::FourPlumes), 4U);
}

}  // namespace
}  // namespace prostm::methods
