#include "prostm/am/am_planner.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "plan/random_fields.hpp"
#include "prostm/am/am_pressures.hpp"
#include "prostm/core/random.hpp"
#include "prostm/fields/fields.hpp"
#include "prostm/plan/quasi_static/quasi_static.hpp"
#include "prostm/score/score.hpp"
#include "prostm/target/pressure_share.hpp"
#include "support/heap_guard.hpp"

namespace prostm {
namespace {

constexpr double kSigma = 8.6e-3;

AmSettings settings_of(int foci, double sigma = kSigma) {
  AmSettings settings;
  settings.foci = foci;
  settings.sigma = sigma;
  return settings;
}

Plan plan_of(const TargetField& target, const AmSettings& settings,
             PlanStatus expected = PlanStatus::Planned) {
  AmPlanner planner(settings, target.size());
  Plan plan;
  PlanStats stats;
  EXPECT_EQ(planner.plan(target, plan, stats), expected);
  EXPECT_TRUE(plan.paths.empty());
  return plan;
}

TargetField skin(int rows, int cols, double cell = 5e-3) {
  TargetField target;
  target.resize(rows, cols);
  target.cell = cell;
  target.skin.assign(target.size(), 1);
  return target;
}

/// Computes (B1) to (B3) literally, each as a plain loop.
Plan plain_am(const TargetField& target, int count, double sigma) {
  std::vector<Vec2> centre;
  while (static_cast<int>(centre.size()) < count) {
    std::size_t best = target.size();
    for (std::size_t i = 0; i < target.size(); ++i) {
      bool apart = target.skin[i] != 0 && target.pressure[i] > 0.0;
      for (const Vec2& c : centre) apart = apart && (target.position(i) - c).norm() > sigma;
      if (apart && (best == target.size() || target.pressure[i] > target.pressure[best])) best = i;
    }
    if (best == target.size()) break;
    centre.push_back(target.position(best));
  }
  const auto nearest = [&](const Vec2& x, std::size_t present) {
    for (std::size_t c = 0; c < centre.size(); ++c) {
      if ((x - centre[c]).squaredNorm() < (x - centre[present]).squaredNorm()) present = c;
    }
    return present;
  };
  std::vector<std::size_t> label(target.size(), 0);
  for (bool changed = true, first = true; changed; first = false) {
    changed = first;
    for (std::size_t i = 0; i < target.size(); ++i) {
      const std::size_t c = nearest(target.position(i), label[i]);
      changed = changed || c != label[i];
      label[i] = c;
    }
    for (std::size_t c = 0; c < centre.size(); ++c) {
      Vec2 sum = Vec2::Zero();
      double mass = 0.0;
      for (std::size_t i = 0; i < target.size(); ++i) {
        if (target.skin[i] == 0 || label[i] != c) continue;
        sum += target.pressure[i] * target.position(i);
        mass += target.pressure[i];
      }
      if (mass > 0.0) centre[c] = sum / mass;
    }
  }
  Plan plan;
  for (std::size_t c = 0; c < centre.size(); ++c) {
    double product = 0.0, square = 0.0;
    for (std::size_t i = 0; i < target.size(); ++i) {
      if (target.skin[i] == 0 || nearest(target.position(i), 0) != c) continue;
      const double phi =
          std::exp(-(target.position(i) - centre[c]).squaredNorm() / (2.0 * sigma * sigma));
      product += target.pressure[i] * phi;
      square += phi * phi;
    }
    plan.foci.push_back({0, centre[c], product / square});
  }
  return plan;
}

TEST(AmPlanner, MatchesThePlainAlgorithm) {
  Random random(4);
  for (int trial = 0; trial < 60; ++trial) {
    TargetField target = trial < 9
                             ? fields::make(fields::kPatterns[static_cast<std::size_t>(trial)], 20)
                             : skin(8 + random.below(20), 8 + random.below(20));
    if (trial >= 9) {
      test::add_blobs(target, random);
      for (double& p : target.pressure) p += 1e-6;  // values below 1e-12 of the highest count as 0
    }
    // both decide from the same numbers
    const double most = max_pressure(target);
    for (double& p : target.pressure) p = pressure_share(p, most);
    const int count = 1 + random.below(8);
    const double sigma = random.uniform(6e-3, 32e-3);
    const Plan plan = plan_of(target, settings_of(count, sigma));
    const Plan plain = plain_am(target, count, sigma);
    ASSERT_EQ(plan.foci.size(), plain.foci.size()) << trial;
    for (std::size_t k = 0; k < plan.foci.size(); ++k) {
      EXPECT_LT((plan.foci[k].position - plain.foci[k].position).norm(), 1e-9) << trial;
      EXPECT_NEAR(plan.foci[k].pressure, plain.foci[k].pressure, 1e-6 * plain.foci[k].pressure)
          << trial;
    }
  }
}

TEST(AmPlanner, PressuresMinimiseTheError) {
  Random random(8);
  for (int trial = 0; trial < 30; ++trial) {
    TargetField target = skin(12, 15);
    test::add_blobs(target, random);
    const double sigma = random.uniform(5e-3, 30e-3);
    Plan plan = plan_of(target, settings_of(4, sigma));
    std::vector<double> field(target.size());
    const auto error = [&] {
      quasi_static_field(plan, 0, target, sigma, GainLaw{}, field);
      double sum = 0.0;
      for (std::size_t i = 0; i < field.size(); ++i)
        sum += (field[i] - target.pressure[i]) * (field[i] - target.pressure[i]);
      return sum;
    };
    const double least = error();
    for (FocalPoint& focus : plan.foci) {
      const double solved = focus.pressure;
      for (const double share : {0.0, 0.5, 0.9, 0.999, 1.001, 1.1, 2.0}) {
        focus.pressure = share * solved;
        EXPECT_GT(error(), least) << share;
      }
      focus.pressure = solved;
    }
  }
}

TEST(AmPlanner, FourBlobsGetAFocusEach) {
  TargetField target = skin(41, 41, 4e-3);
  for (std::size_t i = 0; i < target.size(); ++i) {
    const Vec2 x = target.position(i) - Vec2(0.08, 0.08);
    const Vec2 from(std::abs(x.x()) - 0.04, std::abs(x.y()) - 0.04);
    target.pressure[i] = std::exp(-from.squaredNorm() / (2.0 * kSigma * kSigma));
  }
  const Plan plan = plan_of(target, settings_of(4));
  ASSERT_EQ(plan.foci.size(), 4u);
  for (const FocalPoint& focus : plan.foci) {
    EXPECT_NEAR(std::abs(focus.position.x() - 0.08), 0.04, 1e-3);
    EXPECT_NEAR(std::abs(focus.position.y() - 0.08), 0.04, 1e-3);
    EXPECT_NEAR(focus.pressure, 1.0, 0.01);  // φ itself, up to the tails of the others
    EXPECT_NEAR(focus.pressure, plan.foci[0].pressure, 1e-9);
  }
  EXPECT_GT(score_plan(target, plan, 0, kSigma, GainLaw{}).correlation, 0.999);
}

TEST(AmPlanner, AWideFlatFieldGetsTwiceItsPressure) {
  // Σ φ / Σ φ² is 2 for a Gaussian that ends within the field
  TargetField target = skin(61, 61, 2e-3);
  target.pressure.assign(target.size(), 3.0);
  const Plan plan = plan_of(target, settings_of(1));
  ASSERT_EQ(plan.foci.size(), 1u);
  EXPECT_LT((plan.foci[0].position - Vec2(0.06, 0.06)).norm(), 1e-12);
  EXPECT_NEAR(plan.foci[0].pressure, 6.0, 1e-3);
}

TEST(AmPlanner, UnusualFieldsArePlanned) {
  // one cell
  TargetField one = skin(5, 5);
  one.skin.assign(one.size(), 0);
  test::touch(one, 2, 3, 7.0);
  Plan plan = plan_of(one, settings_of(4));
  ASSERT_EQ(plan.foci.size(), 1u);
  EXPECT_EQ(plan.foci[0].position, one.position(2, 3));
  EXPECT_EQ(plan.foci[0].pressure, 7.0);

  // two cells farther apart than σ, then closer
  test::touch(one, 2, 1, 5.0);
  EXPECT_EQ(plan_of(one, settings_of(4)).foci.size(), 2u);
  EXPECT_EQ(plan_of(one, settings_of(4, 11e-3)).foci.size(), 1u);

  // equal pressures: the raster's first cell is chosen first, so results are repeatable
  TargetField flat = skin(9, 9);
  flat.pressure.assign(flat.size(), 1.0);
  plan = plan_of(flat, settings_of(3));
  ASSERT_EQ(plan.foci.size(), 3u);
  const Plan again = plan_of(flat, settings_of(3));
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(plan.foci[k].position, again.foci[k].position);
    EXPECT_EQ(plan.foci[k].pressure, again.foci[k].pressure);
  }

  // a ring, whose middle no focus can render
  TargetField ring = skin(61, 61);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const double r = (ring.position(i) - Vec2(0.15, 0.15)).norm();
    ring.skin[i] = r > 0.10 && r < 0.12 ? 1 : 0;
    ring.pressure[i] = ring.skin[i];
  }
  plan_of(ring, settings_of(1), PlanStatus::EmptyTarget);

  // empty and invalid targets
  plan_of(skin(4, 4), settings_of(4), PlanStatus::EmptyTarget);
  TargetField broken = skin(4, 4);
  broken.pressure[5] = std::numeric_limits<double>::quiet_NaN();
  plan_of(broken, settings_of(4), PlanStatus::InvalidTarget);
}

TEST(AmPlanner, AnyFieldGivesAGoodPlanOrNone) {
  Random random(77);
  for (int trial = 0; trial < 3000; ++trial) {
    const test::RandomField field = test::random_field(random, 24);
    AmPlanner planner(settings_of(1 + random.below(8), random.uniform(1e-3, 0.1)),
                      field.field.pressure.size());
    Plan plan;
    PlanStats stats;
    const PlanStatus status = planner.plan(field.field, plan, stats);
    ASSERT_EQ(status == PlanStatus::InvalidTarget, field.kind == test::FieldKind::Invalid) << trial;
    ASSERT_EQ(plan.foci.empty(), status != PlanStatus::Planned) << trial;
    ASSERT_LE(plan.foci.size(), 8u);
    const double reach = 1.2e5;  // 3 × this exceeds e^12.5, for skin at the limit of 5 σ
    for (const FocalPoint& focus : plan.foci) {
      ASSERT_TRUE(focus.position.allFinite()) << trial;
      ASSERT_GE(focus.pressure, 0.0) << trial;
      ASSERT_LE(focus.pressure, 3.0 * reach * max_pressure(field.field)) << trial;
    }
  }
}

TEST(AmPlanner, ScalesWithThePressure) {
  const TargetField target = fields::make(fields::Pattern::FourPlumes, 3);
  const Plan plan = plan_of(target, settings_of(4));
  for (const double scale : {1e-290, 0.5, 1e290}) {
    TargetField scaled = target;
    for (double& p : scaled.pressure) p *= scale;
    const Plan other = plan_of(scaled, settings_of(4));
    ASSERT_EQ(other.foci.size(), plan.foci.size());
    for (std::size_t k = 0; k < plan.foci.size(); ++k) {
      EXPECT_LT((other.foci[k].position - plan.foci[k].position).norm(), 1e-9);
      EXPECT_NEAR(other.foci[k].pressure / scale, plan.foci[k].pressure,
                  1e-9 * plan.foci[k].pressure);
    }
  }
}

TEST(AmPlanner, TwoHandsShareTheFoci) {
  TargetFrame frame;
  frame.patches.push_back(fields::make(fields::Pattern::OnePlume, 0));
  frame.patches.push_back(fields::make(fields::Pattern::Fingertips, 0));
  AmPlanner planner(settings_of(4), frame.patches[0].size());
  Plan plan;
  PlanStats stats;
  ASSERT_EQ(planner.plan(frame, plan, stats), PlanStatus::Planned);
  int on[2] = {0, 0};
  for (const FocalPoint& focus : plan.foci) ++on[focus.patch];
  EXPECT_GE(on[0], 1);
  EXPECT_GE(on[1], 1);
  EXPECT_EQ(on[0] + on[1], 4);
  // each patch is planned as if it were alone
  const Plan alone = plan_of(frame.patches[0], settings_of(on[0]));
  for (std::size_t k = 0; k < alone.foci.size(); ++k)
    EXPECT_EQ(plan.foci[k].position, alone.foci[k].position);

  frame.patches[1].pressure[0] = -1.0;
  EXPECT_EQ(planner.plan(frame, plan, stats), PlanStatus::InvalidTarget);
  EXPECT_TRUE(plan.empty());
}

TEST(AmPlanner, DoesNotAllocate) {
  TargetFrame frame;
  frame.patches.push_back(fields::make(fields::Pattern::Noise, 0));
  frame.patches.push_back(fields::make(fields::Pattern::Ring, 0));
  AmPlanner planner(settings_of(8), frame.patches[0].size());
  Plan plan;
  PlanStats stats;
  const test::HeapGuard guard;
  for (int k = 0; k < 3; ++k) {
    planner.plan(frame, plan, stats);
    planner.plan(frame.patches[0], plan, stats);
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(AmPlanner, SettingsAreChecked) {
  for (const AmSettings& bad : {settings_of(0), settings_of(9), settings_of(4, 0.0),
                                settings_of(4, std::nan("")), settings_of(4, 0.2)}) {
    EXPECT_THROW(AmPlanner(bad, 100), std::invalid_argument);
  }
  AmSettings bad;
  bad.lloyd_iterations = 0;
  EXPECT_THROW(AmPlanner(bad, 100), std::invalid_argument);
}

TEST(SetPressures, OfCoincidingFociOneRemains) {
  TargetField target = skin(5, 5);
  target.pressure.assign(target.size(), 1.0);
  FocalPoints foci;
  for (int k = 0; k < 3; ++k) foci.push_back({0, target.position(2, 2), 0.0});
  set_pressures(target, kSigma, foci);
  EXPECT_EQ(foci.size(), 1u);
}

TEST(AmPlanner, TheUnitOfPressureDoesNotMoveFoci) {
  for (const fields::Pattern pattern : fields::kPatterns) {
    const TargetField field = fields::make(pattern, 5);
    const Plan plan = plan_of(field, settings_of(4));
    for (const double unit : {0.1, 3.7, 10.0, 1000.0, 1e9, 1e-9}) {
      TargetField scaled = field;
      for (double& p : scaled.pressure) p *= unit;
      const Plan other = plan_of(scaled, settings_of(4));
      ASSERT_EQ(plan.foci.size(), other.foci.size());
      for (std::size_t k = 0; k < plan.foci.size(); ++k) {
        EXPECT_LE((plan.foci[k].position - other.foci[k].position).norm(), 1e-9);
        EXPECT_NEAR(other.foci[k].pressure / (unit * plan.foci[k].pressure), 1.0, 1e-9);
      }
    }
  }
}

}  // namespace
}  // namespace prostm
