/// The pressure of the smoke, separated from that of the hand's own movement.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "prostm/pipeline/pipeline.hpp"
#include "support/heap_guard.hpp"

namespace prostm {
namespace {

PipelineSettings settings_of(PressurePart part, const char* scene = "four-plumes") {
  PipelineSettings settings;
  settings.scene = scene;
  settings.fluid.cells = 32;
  settings.fluid_pressure.part = part;
  settings.jets.trim_rate = 0.0;  // the trim follows the selected part
  return settings;
}

/// The pressures of each target.
std::vector<std::vector<double>> pressures(const PipelineSettings& settings, bool still) {
  auto hands =
      still ? make_study_hand({}) : make_scripted_hand(settings.scripted_hand, settings.track);
  WorldStage stage(settings, std::move(hands));
  std::vector<std::vector<double>> out;
  WorldFrame frame;
  for (int step = 1; step <= 200; ++step) {
    if (step < 150) {
      stage.run(step, 4.0 + 0.02 * step, 0.02, frame);
    } else {
      const test::HeapGuard guard;
      stage.run(step, 4.0 + 0.02 * step, 0.02, frame);
      EXPECT_EQ(guard.allocations(), 0U);
    }
    if (!frame.targeted || step < 100) continue;
    out.emplace_back();
    for (const TargetField& patch : frame.target.patches)
      out.back().insert(out.back().end(), patch.pressure.begin(), patch.pressure.end());
  }
  return out;
}

double most(const std::vector<std::vector<double>>& all) {
  double out = 0.0;
  for (const auto& one : all)
    for (const double p : one) out = std::max(out, p);
  return out;
}

TEST(PressurePart, AHandAtRestFeelsTheSmokeAlone) {
  const auto all = pressures(settings_of(PressurePart::All), true);
  const auto smoke = pressures(settings_of(PressurePart::Smoke), true);
  const auto movement = pressures(settings_of(PressurePart::Movement), true);
  EXPECT_EQ(smoke, all);
  EXPECT_EQ(most(movement), 0.0);
  EXPECT_GT(most(all), 0.01);
}

TEST(PressurePart, InStillAirAMovingHandFeelsItsMovementAlone) {
  const auto all = pressures(settings_of(PressurePart::All, "still-air"), false);
  EXPECT_EQ(pressures(settings_of(PressurePart::Movement, "still-air"), false), all);
  EXPECT_EQ(most(pressures(settings_of(PressurePart::Smoke, "still-air"), false)), 0.0);
  EXPECT_GT(most(all), 0.01);
  EXPECT_GT(most(pressures(settings_of(PressurePart::Movement), false)), 0.0);
}

// targets clamp pressures at 0, so the parts add up only where neither is clamped
TEST(PressurePart, PartsAddUp) {
  const auto all = pressures(settings_of(PressurePart::All), false);
  const auto smoke = pressures(settings_of(PressurePart::Smoke), false);
  const auto movement = pressures(settings_of(PressurePart::Movement), false);
  ASSERT_EQ(all.size(), smoke.size());
  std::size_t compared = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    ASSERT_EQ(all[i].size(), smoke[i].size());
    for (std::size_t cell = 0; cell < all[i].size(); ++cell) {
      if (smoke[i][cell] == 0.0 || movement[i][cell] == 0.0) continue;
      ASSERT_NEAR(smoke[i][cell] + movement[i][cell], all[i][cell], 1e-6);
      ++compared;
    }
  }
  EXPECT_GT(compared, 300U);
}

/// Targets with both parts, for a hand that moves through four plumes.
std::vector<TargetField> targets_with_parts(PressurePart felt) {
  PipelineSettings settings = settings_of(felt);
  settings.fluid_pressure.parts = true;
  WorldStage stage(settings, make_scripted_hand(settings.scripted_hand, settings.track));
  std::vector<TargetField> out;
  WorldFrame frame;
  for (int step = 1; step <= 120; ++step) {
    stage.run(step, 4.0 + 0.02 * step, 0.02, frame);
    if (frame.targeted && step > 100)
      out.insert(out.end(), frame.target.patches.begin(), frame.target.patches.end());
  }
  return out;
}

// in one run, with their signs
TEST(PressurePart, BothAreInTheTargets) {
  for (const PressurePart felt : {PressurePart::All, PressurePart::Smoke, PressurePart::Movement}) {
    const std::vector<TargetField> targets = targets_with_parts(felt);
    ASSERT_GE(targets.size(), 10U);
    std::size_t below = 0, above = 0;
    for (const TargetField& target : targets) {
      validate(target);
      ASSERT_EQ(target.smoke.size(), target.size());
      for (std::size_t cell = 0; cell < target.size(); ++cell) {
        const double smoke = target.smoke[cell], movement = target.movement[cell];
        const double sum = felt == PressurePart::All     ? smoke + movement
                           : felt == PressurePart::Smoke ? smoke
                                                         : movement;
        ASSERT_NEAR(target.pressure[cell], std::max(0.0, sum), 1e-6);
        below += movement < 0.0 ? 1 : 0;
        above += movement > 0.0 ? 1 : 0;
        if (target.skin[cell] == 0) {
          ASSERT_EQ(std::abs(smoke) + std::abs(movement), 0.0);
        }
      }
    }
    EXPECT_GT(below, 100U);
    EXPECT_GT(above, 100U);
  }
}

TEST(PressurePart, NoneIsInTheTargetsUnlessComputed) {
  WorldStage stage(settings_of(PressurePart::All), make_study_hand({}));
  WorldFrame frame;
  for (int step = 1; step <= 4; ++step) stage.run(step, 0.02 * step, 0.02, frame);
  ASSERT_FALSE(frame.target.patches.empty());
  EXPECT_TRUE(frame.target.patches[0].smoke.empty());
  EXPECT_TRUE(frame.target.patches[0].movement.empty());
}

}  // namespace
}  // namespace prostm
