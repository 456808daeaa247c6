/// Evaluation of the felt field of plans.

#include "prostm/score/felt.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "felt/chosen_paths.hpp"
#include "felt/field_sets.hpp"
#include "felt/front.hpp"
#include "felt/judge.hpp"
#include "felt/kept.hpp"
#include "felt/tables.hpp"
#include "prostm/core/file/file.hpp"
#include "prostm/felt/felt_tables.hpp"
#include "prostm/fields/felt_fields.hpp"
#include "prostm/plan/felt_plan.hpp"
#include "prostm/score/physical.hpp"
#include "prostm/score/plan_percept.hpp"
#include "support/input_errors.hpp"

namespace prostm::bench {
namespace {

TargetField target() {
  return fields::felt_field(fields::FeltKind::BlobPair, 1, fields::Outline::Palm);
}

/// A short loop of two circles in step.
Plan two_circles() {
  Plan plan;
  for (const double x : {-0.018, 0.018}) {
    FocalPath path;
    for (int i = 0; i < 16; ++i) {
      const double angle = 2.0 * 3.14159265358979 * i / 16;
      path.points.emplace_back(x + 0.011 * std::cos(angle), 0.011 * std::sin(angle));
      path.pressure.push_back(1.0 + 0.3 * std::sin(angle));
    }
    path.length = closed_length(path);
    path.speed = 7.0;
    path.period = path.length / path.speed;
    plan.paths.push_back(path);
  }
  return in_step(plan, target(), 0.010);
}

Plan two_foci() {
  Plan plan;
  plan.foci = {{0, Vec2(0.01, 0.0), 1.0, 0.2}, {0, Vec2(-0.02, 0.01), 0.6, 0.0}};
  return plan;
}

const Skin& nominal() {
  static const std::vector<Skin> all = skins();
  return all.front();
}

TEST(FeltJudge, ScoresLikeTheProgram) {
  const TargetField field = target();
  TargetFrame frame;
  frame.patches.push_back(field);
  const TransducerArray array = usx_array();
  WorkerPool pool(2);
  Judge judge(array, field, {nominal()}, {});
  for (const Plan& plan : {two_circles(), two_foci()}) {
    const Judged judged = judge.judge(plan, field, 1);
    EXPECT_NEAR(judged.felt.skill_8,
                plan_percept(plan, frame, 0, EmitSettings(), 40e3, array, pool).skill, 1e-9);
    EXPECT_EQ(judged.skin.front(), judged.felt.skill_8);
    EXPECT_EQ(judged.readout[0], judged.felt.skill_8);

    const Medium air;
    const PackedArray packed(array, air);
    const LoopSamples loop = plan_loop(plan, frame, EmitSettings(), 40e3);
    LoopDriveResult drives;
    loop_drives(
        array, air, loop, {}, [](int, int) { return true; }, drives);
    const PhysicalField physical = physical_field(packed, air, field, loop, drives, 0, pool);
    EXPECT_NEAR(judged.envelope.skill_8, score_physical(field, physical.envelope, 0.0).skill_8,
                1e-6);
    const FeltField felt = FeelingSkin(field).feel(packed, air, field, loop, drives, pool);
    EXPECT_NEAR(judged.intensity, felt.intensity, 1e-9 * felt.intensity);
    for (std::size_t c = 0; c < field.size(); ++c)
      EXPECT_NEAR(judged.percept[c], felt.percept[c], 1e-9 * felt.largest);
  }
}

TEST(FeltJudge, DisturbancesOfSizeZeroChangeNothing) {
  const TargetField field = target();
  const auto still = felt_disturbances({.phase = 0.0, .shift = 0.0, .pressure = 0.0}),
             usual = felt_disturbances();
  Judge judge(usx_array(), field, {nominal()}, still),
      disturbed(usx_array(), field, {nominal()}, usual);
  for (const Plan& plan : {two_circles(), two_foci()}) {
    const Judged calm = judge.judge(plan, field, 1), rough = disturbed.judge(plan, field, 1);
    ASSERT_EQ(calm.disturbed.size(), 4u);
    for (std::size_t d = 0; d < 3; ++d) {
      EXPECT_NEAR(calm.disturbed[d], calm.felt.skill_8, 1e-12) << still[d].name;
      EXPECT_GT(std::abs(rough.disturbed[d] - rough.felt.skill_8), 1e-6) << usual[d].name;
    }
    EXPECT_EQ(judge.judge(plan, field, 1, true).disturbed.size(), 0u);
  }
}

TEST(FeltJudge, SeparatePeriodsTakeThePathsOutOfStep) {
  const TargetField field = target();
  const std::vector<Disturbed> all = felt_disturbances();
  const std::vector<Play> plays = all.back().plays(two_circles(), field, 1);
  ASSERT_EQ(plays.size(), 1u);
  ASSERT_TRUE(plays[0].plan);
  EXPECT_EQ(plays[0].plan->loop, 0.0);
  EXPECT_EQ(plays[0].plan->paths[0].speed, 7.0);
  EXPECT_FALSE(all.back().plays(two_foci(), field, 1)[0].plan);
}

TEST(FeltJudge, StartPhasesKeepThePathAndItsPressures) {
  const Plan plan = two_circles();
  const std::vector<Play> plays = felt_disturbances().front().plays(plan, target(), 1);
  ASSERT_EQ(plays.size(), 4u);
  bool moved = false;
  for (const Play& play : plays) {
    for (std::size_t p = 0; p < plan.paths.size(); ++p) {
      const FocalPath &was = plan.paths[p], &is = play.plan->paths[p];
      const auto first = std::find(was.points.begin(), was.points.end(), is.points[0]);
      ASSERT_NE(first, was.points.end());
      const auto by = static_cast<std::size_t>(first - was.points.begin());
      moved = moved || by != 0;
      for (std::size_t i = 0; i < was.points.size(); ++i) {
        EXPECT_EQ(is.points[i], was.points[(i + by) % was.points.size()]);
        EXPECT_EQ(is.pressure[i], was.pressure[(i + by) % was.points.size()]);
      }
    }
  }
  EXPECT_TRUE(moved);
}

TEST(FeltJudge, CountsCrossingsAndLongPaths) {
  const TargetField field = target();
  Judge judge(usx_array(), field, {nominal()}, {});
  Plan plan = two_circles();
  const Judged good = judge.judge(plan, field, 1);
  EXPECT_EQ(good.crossings, 0);
  EXPECT_EQ(good.long_paths, 0);
  // a tall loop across both edges of the other one
  for (Vec2& x : plan.paths[0].points) x = Vec2(0.5 * x.x() + 0.027, 4.0 * x.y());
  const Judged bad = judge.judge(plan, field, 1);
  EXPECT_EQ(bad.crossings, 4);
  EXPECT_EQ(bad.long_paths, 1);
}

TEST(FeltJudge, CachesItsResults) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("kept.json");
  const std::vector<NamedField> fields = {{"pair", target()}};
  const Planning planning = [](const TargetField&) { return two_circles(); };
  const std::vector<Way> circles = {{"circles", [=](const TargetField&) { return planning; }}};
  const std::vector<Disturbed> disturbances = {felt_disturbances()[1]};
  const auto judged = [&](std::string file) {
    Kept kept(std::move(file));
    return judge_all(usx_array(), fields, circles, {nominal()}, disturbances, 2, kept)[0][0];
  };
  const Judged first = judged(path), again = judged(path), fresh = judged("");
  EXPECT_FALSE(first.percept.empty());
  EXPECT_TRUE(again.percept.empty()) << "evaluated again";
  EXPECT_EQ(fresh.percept, first.percept);
  EXPECT_EQ(again.felt.skill_8, first.felt.skill_8);
  EXPECT_EQ(again.felt.overlap, first.felt.overlap);
  EXPECT_EQ(again.envelope.skill_8, first.envelope.skill_8);
  EXPECT_EQ(again.intensity, first.intensity);
  EXPECT_EQ(again.strongest, first.strongest);
  EXPECT_EQ(again.readout, first.readout);
  EXPECT_EQ(again.skin, first.skin);
  EXPECT_EQ(again.disturbed, first.disturbed);
  write_file(path, "[1]");
  EXPECT_THAT(test::input_error([&] { Kept wrong(path); }), testing::HasSubstr(path));
}

TEST(FeltJudge, WaysWithTheSamePlanHaveTheSameMap) {
  const Way circles{"circles", [](const TargetField&) -> Planning {
                      return [](const TargetField&) { return two_circles(); };
                    }};
  Kept kept("");
  const auto judged =
      judge_all(usx_array(), {{"pair", target()}}, {circles, circles}, {nominal()}, {}, 1, kept);
  EXPECT_EQ(judged[0][0].percept.size(), target().size());
  EXPECT_EQ(judged[1][0].percept, judged[0][0].percept);
}

TEST(FieldSets, AreValidAndShareNoField) {
  std::vector<std::vector<double>> all;
  for (const SetName set : {SetName::Tuning, SetName::Scout, SetName::New, SetName::Drawn,
                            SetName::Redrawn, SetName::Shapes}) {
    const std::vector<NamedField> fields = field_set(set);
    EXPECT_EQ(fields.size(), set == SetName::Shapes ? 4U : 24U);
    for (const NamedField& named : fields) {
      EXPECT_NO_THROW(validate(named.field)) << named.name;
      EXPECT_GT(max_pressure(named.field), 0.9) << named.name;
      all.push_back(named.field.pressure);
    }
  }
  std::sort(all.begin(), all.end());
  EXPECT_EQ(std::adjacent_find(all.begin(), all.end()), all.end());
}

TEST(FeltJudge, ShapeAndStrengthDecideTheNumberOfPaths) {
  const TargetField ring = fields::felt_field(fields::FeltKind::Circle, 1, fields::Outline::Palm);
  PlanSettings settings;
  settings.preset = Preset::Fast;
  settings.felt_weight = 1.0;
  const auto planned = [&](double weight) {
    return chosen_paths("", settings, weight, usx_array()).plan(ring);
  };
  const Plan shaped = planned(0.0), strong = planned(100.0);
  EXPECT_EQ(strong.paths.size(), 1U);
  EXPECT_GT(shaped.paths.size(), 1U);
  const auto lack = [&](const Plan& plan) {
    return felt_plan(plan, ring, sigma_on_skin(usx_array(), ring, settings.sigma), felt_skins())
        .lack;
  };
  EXPECT_LT(lack(shaped), lack(strong));
}

TEST(FeltJudge, KeysDistinguishInputs) {
  const TargetField field = target();
  const Plan plan = two_circles();
  const std::string key = key_of(plan, field, {"nominal"}, 1);
  EXPECT_EQ(key_of(two_circles(), target(), {"nominal"}, 1), key);
  EXPECT_NE(key_of(plan, field, {"nominal"}, 2), key);
  EXPECT_NE(key_of(plan, field, {"nominal", ""}, 1), key);
  const auto changed = [&](auto change) {
    Plan other = plan;
    change(other);
    return key_of(other, field, {"nominal"}, 1);
  };
  EXPECT_NE(changed([](Plan& p) { p.loop = 0.0; }), key);
  EXPECT_NE(changed([](Plan& p) { p.paths[1].pressure[3] *= 1.0 + 1e-12; }), key);
  EXPECT_NE(changed([](Plan& p) { p.paths[0].points[2].y() += 1e-12; }), key);
  EXPECT_NE(changed([](Plan& p) { p.paths[0].speed += 1e-12; }), key);
  const auto of_foci = [&](double phase) {
    Plan foci = two_foci();
    foci.foci[1].phase = phase;
    return key_of(foci, field, {"nominal"}, 1);
  };
  EXPECT_NE(of_foci(0.0), of_foci(0.5));
  TargetField other = field;
  other.pressure[300] *= 1.0 + 1e-12;
  EXPECT_NE(key_of(plan, other, {"nominal"}, 1), key);
}

TEST(FeltTables, PairFields) {
  const Compared c = compare({0.9, 0.7, 0.8}, {0.8, 0.8, 0.5});
  EXPECT_NEAR(c.mean, 0.8, 1e-12);
  EXPECT_NEAR(c.more, 0.1, 1e-12);
  EXPECT_NEAR(c.lack, 0.6 / 0.9, 1e-12);
  EXPECT_NEAR(c.worst, 1.5, 1e-12);
  EXPECT_EQ(c.worst_field, 1u);
  EXPECT_EQ(c.worse, 1);
  // differences 0.1, -0.1, 0.3: standard deviation 0.2
  EXPECT_NEAR(c.error, 0.2 / std::sqrt(3.0), 1e-12);
}

/// Two ways on two fields, by S_8.5 and strength.
JudgedSet two_by_two() {
  const auto judged = [](double skill_8, double strongest) {
    Judged out;
    out.felt.skill_8 = skill_8;
    out.strongest = strongest;
    return out;
  };
  return {"test",
          {"a", "b"},
          {"first", "other, 0.1"},
          {"nominal"},
          {},
          {{judged(0.8, 0.2e-6), judged(0.6, 0.4e-6)}, {judged(0.9, 0.8e-6), judged(0.5, 0.1e-6)}}};
}

TEST(FeltTables, CompareShapeAndStrength) {
  const JudgedSet set = two_by_two();
  EXPECT_NEAR(compare_shape(set, 1).lack, 1.0, 1e-12);
  EXPECT_EQ(compare_shape(set, 1).worse, 1);
  const Strength strength = compare_strength(set, 1);
  EXPECT_NEAR(strength.mean, 0.45e-6, 1e-18);
  EXPECT_NEAR(strength.ratio, 1.5, 1e-12);
  EXPECT_NEAR(strength.least, 0.25, 1e-12);
  EXPECT_EQ(strength.worse_in_both, 1);
  EXPECT_EQ(compare_strength(set, 0).ratio, 1.0);
}

TEST(FeltFront, JoinsWaysOfOneKindByStrength) {
  JudgedSet set = two_by_two();
  set.ways.emplace_back("other, 0 paths");
  set.results.push_back({set.results[0][0], set.results[0][0]});
  const std::vector<Chart> charts = front_charts({set, set});
  ASSERT_EQ(charts.size(), 2u);
  ASSERT_EQ(charts[0].series.size(), 2u);
  const ChartSeries &first = charts[0].series[0], &other = charts[0].series[1];
  EXPECT_EQ(first.name, "first");
  EXPECT_EQ(first.x, std::vector<double>({1.0}));
  EXPECT_EQ(first.y, std::vector<double>({1.0}));
  EXPECT_EQ(other.name, "other");
  EXPECT_EQ(other.labels, std::vector<std::string>({"0", "0.1"}));
  EXPECT_NEAR(other.x[0], 0.4 / 0.6, 1e-12);
  EXPECT_NEAR(other.x[1], 0.9 / 0.6, 1e-12);
  EXPECT_NEAR(other.y[0], 0.4 / 0.6, 1e-12);
  EXPECT_NEAR(other.y[1], 1.0, 1e-12);
}

}  // namespace
}  // namespace prostm::bench
