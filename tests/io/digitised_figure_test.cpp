#include "prostm/io/digitised_figure.hpp"

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "io/examples.hpp"
#include "prostm/core/file/file.hpp"
#include "prostm/io/field/field_file.hpp"
#include "prostm/score/score.hpp"
#include "support/shared.hpp"

namespace prostm {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kFigure =
    R"({"fig2": {"clusters_mm": [[0, 0], [20, 0], [20, 10], [0, 10]],
 "cluster_value_norm": [0.1, 0.2, 0.3, 0.4],
 "initial_tour_mm": [[0, 1], [19, 0], [20, 9], [1, 10], [0, 1]],
 "split_paths_mm": [[[20, 0], [0, 0], [20, 0]], [[20, 10], [0, 10], [20, 10]]],
 "refined_paths_mm": [[[0, 0], [24, 0], [20, 11], [0, 0]], [[0, 10], [60, 10], [0, 10]]],
 "recon_norm": [[0.5, null, 0.25], [0, 1, 2]]}})";

/// Returns two rows of three cells of 10 mm with pressures 1 to 6, the first at the origin.
TargetField target() {
  TargetField field;
  field.resize(2, 3);
  field.cell = 0.01;
  field.skin.assign(6, 1);
  field.pressure = {1, 2, 3, 4, 5, 6};
  return field;
}

DigitisedFigure read(const std::string& text) {
  return digitised_figure_from_json(text, "fig.json", target(), {0.5}, 7.0);
}

TEST(DigitisedFigure, ReadsClustersToursAndReconstruction) {
  const DigitisedFigure figure = read(kFigure);
  EXPECT_THAT(figure.trace.clusters,
              ElementsAre(Vec2(0, 0), Vec2(0.02, 0), Vec2(0.02, 0.01), Vec2(0, 0.01)));
  EXPECT_THAT(figure.trace.cluster_mass, ElementsAre(0.1, 0.2, 0.3, 0.4));
  EXPECT_THAT(figure.reconstruction, ElementsAre(0.5, 0, 0.25, 0, 1, 2));

  // each corner of a tour selects the nearest cluster
  EXPECT_THAT(figure.trace.tour, ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(figure.trace.split, ElementsAre(ElementsAre(1, 0), ElementsAre(2, 3)));
}

TEST(DigitisedFigure, GivesPathsTheTargetsPressureTimesTheGain) {
  const Plan plan = read(kFigure).plan;
  ASSERT_EQ(plan.paths.size(), 2u);
  EXPECT_THAT(plan.paths[0].points, ElementsAre(Vec2(0, 0), Vec2(0.024, 0), Vec2(0.02, 0.011)));
  EXPECT_THAT(plan.paths[0].pressure, ElementsAre(0.5, 1.5, 3.0));
  EXPECT_THAT(plan.paths[1].pressure, ElementsAre(2.0, 0.0));  // (60, 10) is off the raster
  const double length = 1e-3 * (24.0 + std::hypot(4.0, 11.0) + std::hypot(20.0, 11.0));
  EXPECT_NEAR(plan.paths[0].length, length, 1e-15);
  EXPECT_EQ(plan.paths[0].speed, 7.0);
  EXPECT_NEAR(plan.paths[0].period, length / 7.0, 1e-15);
  EXPECT_NEAR(plan.paths[1].length, 0.12, 1e-15);
}

TEST(DigitisedFigure, ReportsErrors) {
  test::expect_refused(
      kFigure, "fig.json",
      {{"\"fig2\"", "\"fig3\"", "\"fig2\" is missing; it must be a digitised figure"},
       {"\"clusters_mm\"", "\"clusters\"", "\"fig2\".clusters_mm is missing; it must be an array"},
       {"[[0, 0], [20, 0], [20, 10], [0, 10]]", "[]", "\"fig2\" must have at least one cluster"},
       {"[20, 10], [0, 10]]", "[20, 10], [0]]", "clusters_mm[3] has 1 numbers; it must have 2"},
       {"[20, 10], [0, 10]]", "[20, 10], [0, 1e12]]", "clusters_mm[3][1] is 1000000000000"},
       {"0.3, 0.4]", "0.3]", "cluster_value_norm must have a number per cluster"},
       {"0.3, 0.4]", "0.3, -0.4]", "cluster_value_norm[3] is -0.4; it must be from 0 to"},
       {"\"initial_tour_mm\"", "\"tour\"", "initial_tour_mm is missing; it must be a closed line"},
       {"[1, 10], [0, 1]]", "[1, 10]]", "initial_tour_mm must be a closed line"},
       {"[[20, 0], [0, 0], [20, 0]]", "[[20, 0]]",
        "split_paths_mm[0] must be a closed line of at "
        "least two points"},
       {"[0, 10], [60, 10], [0, 10]", "[0, 10], [60, 10]", "refined_paths_mm[1] must be a closed"},
       {"[0, 10], [60, 10], [0, 10]", "", "refined_paths_mm[1] must be a closed line"},
       {"\"recon_norm\"", "\"recon\"", "recon_norm is missing; it must be a matrix"},
       {", [0, 1, 2]]", "]", "recon_norm has 1 rows; it must have \"rows\" = 2"},
       {"[0, 1, 2]]", "[0, 1]]", "recon_norm[1] has 2 numbers"},
       {"[0, 1, 2]]", "[0, 1, -2]]", "recon_norm[1][2] is -2; it must be from 0"},
       {"[0, 1, 2]]", "[0, 1, \"2\"]]", "recon_norm[1][2]"},
       {"[0, 1, 2]]", "[0, 1, 2]", "not valid JSON"}},
      [](const std::string& text) { read(text); });
}

TEST(DigitisedFigure, RejectsTooManyPathsAndPoints) {
  const auto sentence = [](const std::function<void(nlohmann::json&)>& change) {
    auto json = nlohmann::json::parse(kFigure);
    change(json["fig2"]["refined_paths_mm"]);
    return test::input_error([&] { read(json.dump()); });
  };
  EXPECT_THAT(sentence([](auto& paths) {
                while (paths.size() < 9) paths.push_back(paths[0]);
              }),
              HasSubstr("refined_paths_mm must have at most 8 paths"));
  EXPECT_THAT(sentence([](auto& paths) {
                const nlohmann::json point = paths[0][1];
                while (paths[0].size() < 66) paths[0].insert(paths[0].begin(), point);
                paths[0][0] = paths[0].back();
              }),
              HasSubstr("refined_paths_mm[0] must have at most 64 points"));
}

TEST(DigitisedFigure, ThePapersOwnPathsScoreAsMeasured) {
  PROSTM_NEEDS_SHARED("data/paper/fig2.json");
  const TargetField field = read_field(test::shared_file("data/paper/fig2.field.json"));
  const std::string name = test::shared_file("data/paper/fig2.json");
  const PlanSettings settings;
  const DigitisedFigure figure =
      digitised_figure_from_json(read_file(name), name, field, settings.gain_law(), settings.speed);
  EXPECT_EQ(figure.trace.clusters.size(), 23u);
  EXPECT_EQ(figure.trace.split.size(), 4u);
  EXPECT_EQ(figure.plan.paths.size(), 4u);
  EXPECT_EQ(figure.reconstruction.size(), field.size());
  const Metrics metrics = score_plan(field, figure.plan, 0, 8.6e-3, settings.gain_law());
  EXPECT_NEAR(metrics.correlation, 0.899, 0.002);
  EXPECT_NEAR(metrics.rmse, 0.119, 0.002);
  EXPECT_NEAR(metrics.coverage, 0.608, 0.003);
}

}  // namespace
}  // namespace prostm
