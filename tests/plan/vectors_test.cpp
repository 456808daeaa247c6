/// The planner on every vector target of this processor.

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>

#include "prostm/fields/fields.hpp"
#include "prostm/plan/planner.hpp"
#include "prostm/score/score.hpp"
#include "support/load.hpp"
#include "support/only_targets.hpp"

namespace prostm {
namespace {

using fields::kPatterns;
using test::OnlyTargets;
using test::vector_targets;

/// Returns the mean RMSE of each pattern over some frames of its sequence.
std::array<double, kPatterns.size()> gallery_rmse(const PlanSettings& settings, int frames) {
  Planner planner(settings, static_cast<std::size_t>(fields::kCells) * fields::kCells);
  std::array<double, kPatterns.size()> rmse{};
  for (std::size_t p = 0; p < kPatterns.size(); ++p) {
    for (int i = 0; i < frames; ++i) {
      const TargetField field = fields::make(kPatterns[p], 10 + i * 89 / frames);
      Plan plan;
      PlanStats stats;
      planner.reset();
      planner.plan(field, plan, stats);
      rmse[p] += score_plan(field, plan, 0, settings.sigma, settings.gain_law()).rmse / frames;
    }
  }
  return rmse;
}

double mean(const std::array<double, kPatterns.size()>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// The order of sums and the descent paths differ, but the mean results over many plans must not.
void expect_as_good_as_plain(const PlanSettings& settings, int frames, std::int64_t targets) {
  std::array<double, kPatterns.size()> plain{};
  {
    const OnlyTargets only(test::kPlainTarget);
    plain = gallery_rmse(settings, frames);
  }
  for (; targets != 0; targets &= targets - 1) {
    const std::int64_t target = targets & ~(targets - 1);
    const OnlyTargets only(target);
    const std::array<double, kPatterns.size()> rmse = gallery_rmse(settings, frames);
    EXPECT_NEAR(mean(rmse) / mean(plain), 1.0, 0.01) << hwy::TargetName(target);
    for (std::size_t p = 0; p < rmse.size(); ++p) {
      EXPECT_NEAR(rmse[p] / plain[p], 1.0, 0.10)
          << hwy::TargetName(target) << ", " << fields::to_string(kPatterns[p]);
    }
  }
}

TEST(Vectors, FastRendersTheGalleryEquallyWellOnEveryTarget) {
  PlanSettings settings;
  settings.preset = Preset::Fast;
  expect_as_good_as_plain(settings, 10, vector_targets());
}

TEST(Vectors, BestRendersTheGalleryEquallyWellOnTheBestTarget) {
  if (test::reduced(20) < 20) GTEST_SKIP() << "too long under a sanitizer";
  PlanSettings settings;
  settings.fit_starts = settings.fit_kicks = 2;  // more plans in the same time
  expect_as_good_as_plain(settings, 25, vector_targets() & -vector_targets());
}

}  // namespace
}  // namespace prostm
