#include <cmath>
#include <limits>
#include <stdexcept>

#include "figure/example_figures.hpp"
#include "prostm/core/file/file.hpp"
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

TEST(DrawGallery, ShowsEveryPartOfItsInput) {
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
  changed[1].plans[1].second_caption = "felt";
  const std::string captioned = bytes_of(changed);
  EXPECT_FALSE(captioned == whole);
  changed[1].plans[1].second_caption = "not felt";
  EXPECT_FALSE(bytes_of(changed) == captioned);
  changed = fields;
  changed[0].name = "another";
  EXPECT_FALSE(bytes_of(changed) == whole);
}

TEST(DrawGallery, ShowsFociNotesAndTheRequestedCaption) {
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

TEST(DrawGallery, RejectsInconsistentInput) {
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

/// The file of charts. Two drawings of the same charts differ in SVG: part names are numbered.
std::string bytes_in(const std::string& ending, const std::vector<Chart>& charts,
                     std::size_t in_row = 0) {
  const test::TemporaryFolder folder;
  draw_charts(charts, folder.file("a" + ending), in_row);
  return read_file(folder.file("a" + ending));
}

TEST(DrawCharts, ShowsEveryLine) {
  const auto bytes_of = [](const std::vector<Chart>& charts) { return bytes_in(".png", charts); };
  const std::string whole = bytes_of({chart()});
  EXPECT_TRUE(bytes_of({chart()}) == whole);
  Chart changed = chart();
  changed.series[1].y[1] *= 1.5;
  EXPECT_FALSE(bytes_of({changed}) == whole);
  changed = chart();
  changed.series.pop_back();
  EXPECT_FALSE(bytes_of({changed}) == whole);
  // linear axes, labels, points at and below zero
  Chart linear{"Trade", "a", "b", false, {{"ours", {-1, 0, 2}, {0.1, -0.05, 0.2}}}, false};
  const std::string plain = bytes_of({linear});
  linear.series[0].labels = {"one", "two", "three"};
  EXPECT_FALSE(bytes_of({linear}) == plain);
  // integers along x, a single value
  changed = {"Paths", "paths", "µs", false, {{"ours", {1}, {5}}}};
  EXPECT_TRUE(bytes_in(".svg", {changed}).find("</svg>") != std::string::npos);
}

TEST(DrawCharts, ShowsDotsAndIntervals) {
  const auto bytes_of = [](const std::vector<Chart>& charts, std::size_t in_row) {
    return bytes_in(".png", charts, in_row);
  };
  Chart chart{"Fit", "level", "right", false, {{"ours", {0, 1}, {0.5, 1}}}, false};
  const std::string line = bytes_of({chart}, 0);
  chart.series[0].dots = {{0.2, 0.6, 4.0}, {0.8, 0.9, 1.0}};
  const std::string dots = bytes_of({chart}, 0);
  EXPECT_FALSE(dots == line);
  chart.series[0].dots[0].area = 5.0;
  EXPECT_FALSE(bytes_of({chart}, 0) == dots);
  chart.series[0].span = {0.4, 0.5, 0.6, 0.75};
  const std::string span = bytes_of({chart}, 0);
  chart.series[0].span->high = HUGE_VAL;
  EXPECT_FALSE(bytes_of({chart}, 0) == span);
  chart.series[0].x.clear();
  chart.series[0].y.clear();
  EXPECT_TRUE(bytes_in(".svg", {chart}).find("</svg>") != std::string::npos);
  EXPECT_FALSE(bytes_of({chart, chart, chart}, 2) == bytes_of({chart, chart, chart}, 3));
  EXPECT_TRUE(bytes_of({chart, chart, chart}, 0) == bytes_of({chart, chart, chart}, 3));
  chart.series[0].dots = {{1.0, 0.5, 1.0}, {std::nextafter(1.0, 2.0), 0.6, 1.0}};  // tiny range
  EXPECT_TRUE(bytes_in(".svg", {chart}).find("</svg>") != std::string::npos);
  chart.series[0].dots[0].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(bytes_of({chart}, 0), std::invalid_argument);
}

TEST(DrawCharts, RejectsValuesWithoutAPositionOnTheAxes) {
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
