#include <cmath>
#include <limits>
#include <stdexcept>

#include "figure/example_figures.hpp"
#include "prostm/core/file.hpp"
#include "support/input_errors.hpp"

namespace prostm {
namespace {

std::vector<GalleryField> gallery_of(int fields, int plans) {
  const test::PlannedExample example;
  GalleryField field{"hand", example.target, {}};
  for (int i = 0; i < plans; ++i) {
    field.plans.push_back({"planner " + std::to_string(i), example.plan,
                           example.figure.reconstruction, example.figure.metrics});
  }
  return std::vector<GalleryField>(static_cast<std::size_t>(fields), field);
}

Chart chart() {
  return {
      "Time",
      "points",
      "µs",
      true,
      {{"ours", {1e3, 1e4, 1e5}, {100, 700, 8000}}, {"theirs", {1e3, 1e4, 1e5}, {9e3, 8e4, 9e5}}}};
}

TEST(DrawGallery, ShowsEveryPartOfWhatItIsGiven) {
  const test::TemporaryFolder folder;
  const auto bytes_of = [&](const std::vector<GalleryField>& fields) {
    draw_gallery({"All"}, fields, folder.file("a.png"));
    return read_file(folder.file("a.png"));
  };
  const std::vector<GalleryField> fields = gallery_of(4, 2);
  const std::string whole = bytes_of(fields);
  EXPECT_TRUE(whole == bytes_of(fields));

  std::vector<GalleryField> changed = fields;
  changed[3].plans[1].metrics.skill_8 -= 0.1;
  EXPECT_FALSE(bytes_of(changed) == whole);
  changed = fields;
  changed[1].plans[0].plan.paths[0].points[0] += Vec2(0.01, 0.01);
  EXPECT_FALSE(bytes_of(changed) == whole);
  changed = fields;
  changed[2].plans[1].rendered.assign(changed[2].target.size(), 0.0);
  EXPECT_FALSE(bytes_of(changed) == whole);
  changed = fields;
  changed[0].name = "another";
  EXPECT_FALSE(bytes_of(changed) == whole);
}

TEST(DrawGallery, ShowsFociNotesAndTheCaptionThatIsAskedFor) {
  const test::TemporaryFolder folder;
  std::vector<GalleryField> fields = gallery_of(2, 1);
  const auto bytes_of = [&](const GalleryPage& page) {
    draw_gallery(page, fields, folder.file("a.png"));
    return read_file(folder.file("a.png"));
  };
  const std::string plain = bytes_of({"All"});
  EXPECT_FALSE(bytes_of({"All", "with care"}) == plain);
  EXPECT_FALSE(bytes_of({"All", "", GalleryCaption::Correlation}) == plain);
  fields[0].plans[0].plan.clear();
  const std::string empty = bytes_of({"All"});
  fields[0].plans[0].plan.foci.push_back({0, fields[0].target.position(2, 2), 1.0});
  EXPECT_FALSE(bytes_of({"All"}) == empty);
}

TEST(DrawGallery, RefusesWhatDoesNotFitTogether) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("a.png");
  EXPECT_THROW(draw_gallery({"None"}, {}, path), std::invalid_argument);
  std::vector<GalleryField> fields = gallery_of(2, 2);
  fields[1].plans.pop_back();
  EXPECT_THROW(draw_gallery({"Odd"}, fields, path), std::invalid_argument);
  fields = gallery_of(1, 1);
  fields[0].plans[0].rendered.pop_back();
  EXPECT_THROW(draw_gallery({"Short"}, fields, path), std::invalid_argument);
  EXPECT_EQ(folder.entries(), 0u);
  test::input_error([&] { draw_gallery({"Name"}, gallery_of(1, 1), folder.file("a.gif")); });
}

TEST(DrawCharts, ShowsEveryLine) {
  const test::TemporaryFolder folder;
  const auto bytes_of = [&](const std::vector<Chart>& charts) {
    draw_charts(charts, folder.file("a.svg"));
    return read_file(folder.file("a.svg"));
  };
  const std::string whole = bytes_of({chart()});
  Chart changed = chart();
  changed.series[1].y[1] *= 1.5;
  EXPECT_FALSE(bytes_of({changed}) == whole);
  changed = chart();
  changed.series.pop_back();
  EXPECT_FALSE(bytes_of({changed}) == whole);
  // linear axes, labels, points at zero and below
  Chart linear{"Trade", "a", "b", false, {{"ours", {-1, 0, 2}, {0.1, -0.05, 0.2}}}, false};
  const std::string plain = bytes_of({linear});
  EXPECT_TRUE(plain.find("</svg>") != std::string::npos);
  linear.series[0].labels = {"one", "two", "three"};
  EXPECT_FALSE(bytes_of({linear}) == plain);
  // whole numbers along x, a single value
  changed = {"Paths", "paths", "µs", false, {{"ours", {1}, {5}}}};
  EXPECT_TRUE(bytes_of({changed}).find("</svg>") != std::string::npos);
}

TEST(DrawCharts, RefusesWhatHasNoPlaceOnTheAxes) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("a.svg");
  EXPECT_THROW(draw_charts({}, path), std::invalid_argument);
  EXPECT_THROW(draw_charts({Chart{}}, path), std::invalid_argument);
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::infinity(),
                           std::numeric_limits<double>::quiet_NaN()}) {
    Chart broken = chart();
    broken.series[0].y[2] = bad;
    EXPECT_THROW(draw_charts({broken}, path), std::invalid_argument);
  }
  Chart broken = chart();
  broken.series[0].x.pop_back();
  EXPECT_THROW(draw_charts({broken}, path), std::invalid_argument);
  broken = chart();
  broken.series[0].labels = {"one"};
  EXPECT_THROW(draw_charts({broken}, path), std::invalid_argument);
  broken = chart();
  broken.logarithmic_y = false;
  broken.series[0].y[2] = -1.0;
  broken.series[0].x[0] = 0.0;
  EXPECT_THROW(draw_charts({broken}, path), std::invalid_argument);
  EXPECT_EQ(folder.entries(), 0u);
}

}  // namespace
}  // namespace prostm
