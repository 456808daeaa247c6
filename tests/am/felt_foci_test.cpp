#include "prostm/am/detail/felt_foci.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "plan/random_fields.hpp"
#include "prostm/acoustics/skin/skin_percept.hpp"
#include "prostm/acoustics/skin/skin_response.hpp"
#include "prostm/fields/fields.hpp"
#include "prostm/score/physical.hpp"
#include "support/heap_guard.hpp"

namespace prostm {
namespace {

constexpr double kSigma = 8.6e-3, kFrequency = 200.0;

AmSettings settings_of(double felt_weight, int foci = 6) {
  AmSettings settings;
  settings.foci = foci;
  settings.felt_weight = felt_weight;
  return settings;
}

Plan plan_of(const TargetField& target, const AmSettings& settings) {
  AmPlanner planner(settings, target.size());
  Plan plan;
  PlanStats stats;
  EXPECT_EQ(planner.plan(target, plan, stats), PlanStatus::Planned);
  return plan;
}

/// Returns S_8.5 of √e, by the harmonic sum of the skin, for Gaussian foci whose pressures are
/// raised cosines with the planned phases.
double felt_skill_of(const Plan& plan, const TargetField& target) {
  constexpr int kSamples = 16;
  SkinResponse response(SkinModel(SkinSettings()), {target.rows, target.cols, target.cell});
  response.prepare(1.0 / kFrequency, kSamples);
  std::vector<double> pressure(target.size() * kSamples, 0.0);
  for (int k = 0; k < kSamples; ++k) {
    for (const FocalPoint& focus : plan.foci) {
      const double turn = 2.0 * M_PI * (static_cast<double>(k) / kSamples - focus.phase);
      for (std::size_t c = 0; c < target.size(); ++c) {
        const double r = (target.position(c) - focus.position).norm() / kSigma;
        pressure[static_cast<std::size_t>(k) * target.size() + c] +=
            0.5 * focus.pressure * (1.0 - std::cos(turn)) * std::exp(-0.5 * r * r);
      }
    }
  }
  response.respond({1.0 / kFrequency, kSamples, pressure});
  std::vector<double> percept(target.size());
  percept_map(response, percept);
  for (std::size_t c = 0; c < target.size(); ++c) {
    if (target.skin[c] == 0) percept[c] = 0.0;
  }
  return score_physical(target, percept, 0.0).skill_8;
}

TEST(FeltFoci, RaiseTheFeltSkill) {
  double before = 0.0, after = 0.0;
  for (const fields::Pattern pattern : fields::kPatterns) {
    const TargetField target = fields::make(pattern, 20, 40);
    before += 1.0 - felt_skill_of(plan_of(target, settings_of(0.0)), target);
    after += 1.0 - felt_skill_of(plan_of(target, settings_of(1.0)), target);
  }
  EXPECT_LT(after, 0.8 * before);
}

TEST(FeltFoci, KeepTheirPositionsAndNeedNoMoreOutput) {
  for (const fields::Pattern pattern : fields::kPatterns) {
    const TargetField target = fields::make(pattern, 20, 40);
    const Plan in_phase = plan_of(target, settings_of(0.0)),
               felt = plan_of(target, settings_of(1.0));
    ASSERT_EQ(felt.foci.size(), in_phase.foci.size());
    double most = 0.0, together = 0.0;
    for (std::size_t f = 0; f < felt.foci.size(); ++f) {
      EXPECT_EQ(felt.foci[f].position, in_phase.foci[f].position);
      EXPECT_GE(felt.foci[f].phase, 0.0);
      EXPECT_LE(felt.foci[f].phase, 1.0);
      together += in_phase.foci[f].pressure;
    }
    for (int t = 0; t < 64; ++t) {
      double demand = 0.0;
      for (const FocalPoint& focus : felt.foci) {
        demand += 0.5 * focus.pressure * (1.0 - std::cos(2.0 * M_PI * (t / 64.0 - focus.phase)));
      }
      most = std::max(most, demand);
    }
    EXPECT_LE(most, 1.15 * together);  // the 16-norm of 16 instants is not quite the maximum
  }
}

TEST(FeltFoci, AreFiniteForAnyTargetAndRepeatable) {
  Random random(21);
  const AmSettings settings = settings_of(0.9, 8);
  AmPlanner planner(settings, 64 * 64), again(settings, 64 * 64);
  for (int draw = 0; draw < 100; ++draw) {
    const test::RandomField any = test::random_field(random, 40);
    Plan plan, same;
    PlanStats stats;
    if (planner.plan(any.field, plan, stats) != PlanStatus::Planned) continue;
    again.plan(any.field, same, stats);
    ASSERT_EQ(plan.foci.size(), same.foci.size());
    for (std::size_t f = 0; f < plan.foci.size(); ++f) {
      ASSERT_TRUE(std::isfinite(plan.foci[f].pressure) && plan.foci[f].pressure >= 0.0);
      ASSERT_TRUE(is_phase(plan.foci[f].phase)) << plan.foci[f].phase;
      ASSERT_EQ(plan.foci[f].pressure, same.foci[f].pressure);
      ASSERT_EQ(plan.foci[f].phase, same.foci[f].phase);
    }
  }
}

TEST(FeltFoci, DoNotAllocate) {
  AmPlanner planner(settings_of(0.9), fields::kCells * fields::kCells);
  const TargetField field = fields::make(fields::Pattern::Ring, 1);
  Plan plan;
  PlanStats stats;
  const test::HeapGuard guard;
  planner.plan(field, plan, stats);
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace prostm
