#include "prostm/io/plan_file.hpp"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "io/examples.hpp"
#include "io/random_field.hpp"

namespace prostm {
namespace {

using test::input_error;
using testing::HasSubstr;

Plan random_plan(Random& random, int paths) {
  Plan plan;
  for (int i = 0; i < paths; ++i) {
    FocalPath path;
    path.patch = random.below(2);
    const int points = 1 + random.below(kMaxPathPoints);
    for (int k = 0; k < points; ++k) {
      path.points.push_back(
          Vec2(random.below(100000) / 1e3 / 1e3, random.below(100000) / 1e3 / 1e3));
      path.pressure.push_back(random.uniform(0.0, 40.0));
    }
    path.length = closed_length(path);
    path.speed = random.uniform(1.0, 7.0);
    path.period = random.uniform(1.0, 1.5) * path.length / path.speed;  // longer on uneven skin
    plan.paths.push_back(path);
  }
  return plan;
}

std::string example() {
  TargetField field;
  field.resize(2, 2);
  field.cell = 0.005;
  field.skin[1] = 1;
  field.height[1] = 0.001;
  return plan_to_json(test::triangle_plan(), field, {}, {});
}

TEST(PlanFile, RoundTripsPathsAndRaster) {
  Random random(9);
  for (int trial = 0; trial < 200; ++trial) {
    const TargetField field = test::random_field(random);
    const Plan plan = random_plan(random, random.below(kMaxPaths + 1));
    const PlanFile file = plan_from_json(plan_to_json(plan, field, {}, {}), "plan.json");
    ASSERT_EQ(file.plan.paths.size(), plan.paths.size());
    for (std::size_t i = 0; i < plan.paths.size(); ++i) {
      const FocalPath &a = file.plan.paths[i], &b = plan.paths[i];
      EXPECT_EQ(a.patch, b.patch);
      EXPECT_EQ(a.points, b.points);
      EXPECT_EQ(a.pressure, b.pressure);
      EXPECT_EQ(a.speed, b.speed);
      EXPECT_NEAR(a.length, b.length, 1e-15);
      EXPECT_NEAR(a.period, b.period, 1e-15);
    }
    EXPECT_EQ(file.raster.cell, field.cell);
    EXPECT_EQ(file.raster.origin, field.origin);
    EXPECT_EQ(file.raster.skin, field.skin);
    EXPECT_EQ(file.raster.height, field.height);
    EXPECT_TRUE(file.raster.X_DP.isApprox(field.X_DP, 1e-14));
    EXPECT_NO_THROW(validate(file.raster));
  }
}

TEST(PlanFile, DescribesThePlanInTheUnitsOfTheFormat) {
  Random random(3);
  PlanStats stats;
  stats.kmeans = 123e-6;
  stats.total = 4e-3;
  stats.crossings = 2;
  Metrics metrics;
  metrics.rmse = 0.125;
  metrics.correlation = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Control> controls = {{"flat field", metrics}};
  PlanFileExtras extras;
  extras.stats = &stats;
  extras.metrics = &metrics;
  extras.controls = &controls;
  extras.preset = Preset::Paper;
  const Plan plan = random_plan(random, 4);
  PlanSettings settings;
  settings.speed = 6.5;
  const auto json = nlohmann::json::parse(
      plan_to_json(plan, test::random_field(random), extras, {group_of("plan", settings)}));
  EXPECT_EQ(json["format"], "prostm-plan/1");
  EXPECT_EQ(json["method"], "pro-stm");
  EXPECT_EQ(json["preset"], "paper");
  EXPECT_NEAR(json["stage_us"]["kmeans"].get<double>(), 123.0, 1e-9);
  EXPECT_NEAR(json["stage_us"]["total"].get<double>(), 4000.0, 1e-9);
  for (const char* stage : {"init", "tour", "split", "resample", "refine"}) {
    EXPECT_TRUE(json["stage_us"].contains(stage));
  }
  EXPECT_EQ(json["violations"]["crossings"], 2);
  EXPECT_EQ(json["metrics"]["rmse"], 0.125);
  EXPECT_TRUE(json["metrics"]["correlation"].is_null());
  for (const char* metric : {"coverage", "skill_0", "skill_8", "overlap", "spill"}) {
    EXPECT_TRUE(json["metrics"].contains(metric));
  }
  EXPECT_EQ(json["controls"][0]["name"], "flat field");
  EXPECT_EQ(json["settings"]["plan"]["speed"], 6.5);
  const auto& path = json["paths"][0];
  EXPECT_NEAR(path["length_mm"].get<double>(), 1e3 * plan.paths[0].length, 1e-9);
  EXPECT_NEAR(path["period_ms"].get<double>(), 1e3 * plan.paths[0].period, 1e-9);
  EXPECT_NEAR(path["points_mm"][0][1].get<double>(), 1e3 * plan.paths[0].points[0].y(), 1e-9);
}

TEST(PlanFile, OmitsFieldsThatWereNotSet) {
  const auto json = nlohmann::json::parse(example());
  for (const char* key : {"settings", "preset", "metrics", "stage_us", "foci"})
    EXPECT_FALSE(json.contains(key)) << key;
}

Plan two_foci() {
  Plan plan;
  plan.foci.push_back({0, Vec2(0.02, 0.03), 2.5});
  plan.foci.push_back({1, Vec2(-0.02, 0.01), 0.0});
  return plan;
}

std::string foci_example() {
  TargetField field;
  field.resize(1, 1);
  field.cell = 0.005;
  field.skin[0] = 1;
  PlanFileExtras extras;
  extras.method = Method::Am;
  return plan_to_json(two_foci(), field, extras, {});
}

TEST(PlanFile, RoundTripsFoci) {
  const auto json = nlohmann::json::parse(foci_example());
  EXPECT_EQ(json["method"], "am");
  EXPECT_FALSE(json.contains("paths"));
  const PlanFile file = plan_from_json(foci_example(), "am.json");
  EXPECT_EQ(file.method, Method::Am);
  EXPECT_TRUE(file.plan.paths.empty());
  const Plan plan = two_foci();
  ASSERT_EQ(file.plan.foci.size(), plan.foci.size());
  for (std::size_t i = 0; i < plan.foci.size(); ++i) {
    EXPECT_EQ(file.plan.foci[i].patch, plan.foci[i].patch);
    EXPECT_EQ(file.plan.foci[i].position, plan.foci[i].position);
    EXPECT_EQ(file.plan.foci[i].pressure, plan.foci[i].pressure);
  }
}

TEST(PlanFile, WritesAPhaseOnlyIfThereIsOne) {
  EXPECT_EQ(foci_example().find("phase"), std::string::npos);
  auto json = nlohmann::json::parse(foci_example());
  json["foci"][1]["phase"] = 0.375;
  const Plan plan = plan_from_json(json.dump(), "am.json").plan;
  EXPECT_EQ(plan.foci[0].phase, 0.0);
  EXPECT_EQ(plan.foci[1].phase, 0.375);
  PlanFileExtras extras;
  extras.method = Method::Am;
  TargetField field;
  field.resize(1, 1);
  field.cell = 0.005;
  field.skin[0] = 1;
  const auto again = nlohmann::json::parse(plan_to_json(plan, field, extras, {}));
  EXPECT_FALSE(again["foci"][0].contains("phase"));
  EXPECT_EQ(again["foci"][1]["phase"], 0.375);
  json["foci"][1]["phase"] = 1.5;
  EXPECT_THAT(input_error([&] { plan_from_json(json.dump(), "am.json"); }),
              HasSubstr("\"foci\"[1].phase is 1.5; it must be from 0 to 1"));
  json["foci"][1].erase("phase");
  json["loop_ms"] = 20;
  EXPECT_THAT(input_error([&] { plan_from_json(json.dump(), "am.json"); }),
              HasSubstr("has foci and loop_ms; only paths have a loop"));
}

TEST(PlanFile, WritesALoopOnlyIfThereIsOne) {
  EXPECT_EQ(example().find("loop_ms"), std::string::npos);
  auto json = nlohmann::json::parse(example());
  EXPECT_EQ(plan_from_json(json.dump(), "p.json").plan.loop, 0.0);
  json["loop_ms"] = 0;
  EXPECT_EQ(plan_from_json(json.dump(), "p.json").plan.loop, 0.0);
  json["loop_ms"] = 20.1;
  const PlanFile file = plan_from_json(json.dump(), "p.json");
  EXPECT_EQ(file.plan.loop, 20.1 / 1000.0);
  const auto again = nlohmann::json::parse(plan_to_json(file.plan, file.raster, {}, {}));
  EXPECT_EQ(again["loop_ms"], 20.1);
  const auto refused = [&](const nlohmann::json& loop) {
    json["loop_ms"] = loop;
    return input_error([&] { plan_from_json(json.dump(), "p.json"); });
  };
  EXPECT_THAT(refused(0.5), HasSubstr("\"loop_ms\" is 0.5; it must be 0 or from 1 to 1000"));
  EXPECT_THAT(refused(1001), HasSubstr("\"loop_ms\" is 1001; it must be from 0 to 1000"));
  EXPECT_THAT(refused(-20), HasSubstr("\"loop_ms\" is -20; it must be from 0 to 1000"));
  EXPECT_THAT(refused("20"), HasSubstr("\"loop_ms\" is \"20\"; it must be a number"));
}

TEST(PlanFile, ReportsErrorsInFoci) {
  test::expect_refused(foci_example(), "p.json",
                       {{"\"foci\"", "\"paths\": [], \"foci\"", "has both foci and paths"},
                        {"\"foci\"", "\"focii\"", "\"paths\" is missing"},
                        {"20.0,30.0", "20.0", "position_mm has 1 numbers; it must have 2"},
                        {"2.5", "-2.5", "pressure is -2.5"},
                        {"\"patch\": 1", "\"patch\": 2", "patch is 2; it must be from 0 to 1"}},
                       [](const std::string& text) { plan_from_json(text, "p.json"); });
  auto json = nlohmann::json::parse(foci_example());
  for (int i = 0; i < 7; ++i) json["foci"].push_back(json["foci"][0]);
  EXPECT_THAT(input_error([&] { plan_from_json(json.dump(), "p.json"); }),
              HasSubstr("has 9 foci; it must have at most 8"));
}

TEST(PlanFile, IsByteIdenticalForTheSamePlan) {
  EXPECT_EQ(example(), example());
}

TEST(PlanFile, ReportsErrors) {
  test::expect_refused(
      example(), "p.json",
      {
          {"prostm-plan/1", "prostm-field/1", "must be \"prostm-plan/1\""},
          {"\"paths\"", "\"path\"", "\"paths\" is missing"},
          {"[2.5,2.5,2.5]", "[2.5,2.5]",
           "has 2 numbers; it must have one for each of the 3 points"},
          {"[2.5,2.5,2.5]", "[2.5,-2.5,2.5]", "pressure[1] is -2.5"},
          {"[2.5,2.5,2.5]", "[2.5,null,2.5]", "pressure[1] is null; it must be a number"},
          {"\"length_mm\": 120.0", "\"length_mm\": 130",
           "is 130; the closed path through the points is 120.000 mm"},
          {"\"speed_m_s\": 7.0", "\"speed_m_s\": 0", "speed_m_s is 0; it must be from"},
          {"\"period_ms\": 17.1", "\"period_ms\": 16.1",
           "a lap of 120.000 mm at 7 m/s takes at least 17.1429 ms"},
          {"\"patch\": 0", "\"patch\": 2", "patch is 2; it must be from 0 to 1"},
          {"[30.0,0.0]", "[30.0]", "points_mm[1] has 1 numbers; it must have 2"},
          {"\"raster\"", "\"rester\"", "\"raster\" is missing"},
          {"\"plane\"", "\"plain\"", "\"plane\" is missing"},
          {"\"rows\": 2", "\"rows\": 3", "has 2 rows; it must have \"rows\" = 3"},
      },
      [](const std::string& text) { plan_from_json(text, "p.json"); });
}

TEST(PlanFile, AMissingPeriodIsThatOfFlatSkin) {
  auto json = nlohmann::json::parse(example());
  json["paths"][0].erase("period_ms");
  const FocalPath path = plan_from_json(json.dump(), "p.json").plan.paths[0];
  EXPECT_DOUBLE_EQ(path.period, path.length / path.speed);
}

TEST(PlanFile, RejectsTooManyPathsAndPoints) {
  const auto changed = [](const std::function<void(nlohmann::json&)>& change) {
    auto json = nlohmann::json::parse(example());
    change(json);
    return input_error([&] { plan_from_json(json.dump(), "p.json"); });
  };
  EXPECT_THAT(changed([](auto& json) {
                for (int i = 0; i < 8; ++i) json["paths"].push_back(json["paths"][0]);
              }),
              HasSubstr("has 9 paths; it must have at most 8"));
  EXPECT_THAT(changed([](auto& json) {
                auto& path = json["paths"][0];
                for (int i = 0; i < 62; ++i) path["points_mm"].push_back({1, 2});
              }),
              HasSubstr("has 65 points; a path must have from 1 to 64"));
  EXPECT_THAT(changed([](auto& json) { json["paths"][0]["points_mm"].clear(); }),
              HasSubstr("has 0 points"));
}

}  // namespace
}  // namespace prostm
