/// The planner on every set of vector instructions that this processor has.

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <array>
#include <cmath>

#include "fields/fields.hpp"
#include "plan/planner.hpp"
#include "plan/reconstruction.hpp"
#include "score/score.hpp"
#include "support/load.hpp"

namespace prostm {
namespace {

using fields::kPatterns;

/// Lets kernels use these targets alone, until it goes.
class OnlyTargets {
 public:
  explicit OnlyTargets(std::int64_t targets) { set(targets); }
  ~OnlyTargets() { set(0); }
  OnlyTargets(const OnlyTargets&) = delete;
  OnlyTargets& operator=(const OnlyTargets&) = delete;

 private:
  static void set(std::int64_t targets) {
    hwy::SetSupportedTargetsForTest(targets);
    hwy::GetChosenTarget().DeInit();
  }
};

/// Mean RMSE of each pattern over some frames of its sequence.
std::array<double, kPatterns.size()> gallery_rmse(const PlanSettings& settings) {
  Planner planner(settings, static_cast<std::size_t>(fields::kCells) * fields::kCells);
  std::array<double, kPatterns.size()> rmse{};
  constexpr std::array kFrames{20, 50, 80};
  for (std::size_t p = 0; p < kPatterns.size(); ++p) {
    for (const int frame : kFrames) {
      const TargetField field = fields::make(kPatterns[p], frame);
      Plan plan;
      PlanStats stats;
      planner.reset();
      planner.plan(field, plan, stats);
      rmse[p] += score_plan(field, plan, 0, settings.sigma, settings.gain).rmse / kFrames.size();
    }
  }
  return rmse;
}

double mean(const std::array<double, kPatterns.size()>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

class OnEachTarget : public testing::TestWithParam<const char*> {};

/// The order of sums differs, and so do the ways downhill; what comes of them should not.
TEST_P(OnEachTarget, TheGalleryIsRenderedAsWell) {
  PlanSettings settings;
  settings.preset = GetParam();
  settings.fit_kicks = static_cast<int>(test::reduced(8));
  std::array<double, kPatterns.size()> plain{};
  {
    const OnlyTargets only(HWY_EMU128 | HWY_SCALAR);
    plain = gallery_rmse(settings);
  }
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    if ((target & (HWY_EMU128 | HWY_SCALAR)) != 0) continue;
    const OnlyTargets only(target);
    const std::array<double, kPatterns.size()> rmse = gallery_rmse(settings);
    EXPECT_NEAR(mean(rmse) / mean(plain), 1.0, 0.01) << hwy::TargetName(target);
    for (std::size_t p = 0; p < rmse.size(); ++p) {
      EXPECT_NEAR(rmse[p] / plain[p], 1.0, 0.10)
          << hwy::TargetName(target) << ", " << fields::to_string(kPatterns[p]);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Presets, OnEachTarget, testing::Values("fast", "best"));

}  // namespace
}  // namespace prostm
