#include "prostm/figure/figures.hpp"

#include <functional>
#include <stdexcept>

#include "figure/example_figures.hpp"
#include "prostm/core/file/file.hpp"
#include "prostm/core/units.hpp"
#include "prostm/figure/detail/panel.hpp"
#include "support/input_errors.hpp"

namespace prostm {
namespace {

using testing::HasSubstr;

TEST(DrawPlan, DrawsTheSameBytesForTheSamePlan) {
  const test::TemporaryFolder folder;
  const test::PlannedExample example;
  draw_plan(example.figure, folder.file("a.png"));
  draw_plan(example.figure, folder.file("b.png"));
  const std::string bytes = read_file(folder.file("a.png"));
  EXPECT_TRUE(bytes == read_file(folder.file("b.png")));
  EXPECT_GT(bytes.size(), 50'000u);
  EXPECT_EQ(folder.entries(), 2u);
}

TEST(DrawPlan, WritesVectorGraphics) {
  const test::TemporaryFolder folder;
  const test::PlannedExample example;
  draw_plan(example.figure, folder.file("a.svg"));
  const std::string text = read_file(folder.file("a.svg"));
  EXPECT_TRUE(text.find("</svg>") != text.npos);
  EXPECT_GT(text.size(), 50'000u);
}

TEST(DrawPlan, IsSmallerForAPresetWithoutThePapersSteps) {
  const test::TemporaryFolder folder;
  const test::PlannedExample steps, best(test::hand_field(), "best");
  EXPECT_TRUE(best.trace.clusters.empty());
  draw_plan(steps.figure, folder.file("steps.svg"));
  draw_plan(best.figure, folder.file("best.svg"));
  const std::string six = read_file(folder.file("steps.svg")),
                    three = read_file(folder.file("best.svg"));
  EXPECT_TRUE(three.find("</svg>") != three.npos);
  const auto height = [](const std::string& svg) {
    return std::stod(svg.substr(svg.find("height=\"") + 8));
  };
  EXPECT_LT(height(three), 0.75 * height(six));
  // below a plan with steps, each figure keeps its height
  draw_plan(best.figure, folder.file("both.svg"), &steps.figure);
  EXPECT_GT(height(read_file(folder.file("both.svg"))), height(six) + 0.3 * height(three));
}

TEST(DrawPlan, ShowsEveryPartOfItsInput) {
  const test::TemporaryFolder folder;
  const auto bytes_of = [&](const PlanFigure& figure) {
    draw_plan(figure, folder.file("a.png"));
    return read_file(folder.file("a.png"));
  };
  test::PlannedExample example;
  const std::string whole = bytes_of(example.figure);
  const std::vector<std::function<void(PlanFigure&)>> changes = {
      [](PlanFigure& f) { f.title += "!"; }, [](PlanFigure& f) { f.metrics.rmse += 0.1; },
      [](PlanFigure& f) { f.controls.pop_back(); },
      [](PlanFigure& f) { f.reconstruction.assign(f.reconstruction.size(), 0.0); }};
  for (const auto& change : changes) {
    PlanFigure changed = example.figure;
    change(changed);
    EXPECT_FALSE(bytes_of(changed) == whole);
  }
  example.trace.split.pop_back();
  const std::string less_split = bytes_of(example.figure);
  EXPECT_FALSE(less_split == whole);
  example.trace.tour.pop_back();
  const std::string less_tour = bytes_of(example.figure);
  EXPECT_FALSE(less_tour == less_split);
  example.plan.paths[0].points[0] += Vec2(0.01, 0.01);
  EXPECT_FALSE(bytes_of(example.figure) == less_tour);
}

/// Returns the size of a PNG in pixels along x (0) or y (1), from its header.
int side_of(const std::string& png, std::size_t axis) {
  int side = 0;
  for (std::size_t i = 16 + 4 * axis; i < 20 + 4 * axis; ++i) {
    side = 256 * side + static_cast<unsigned char>(png.at(i));
  }
  return side;
}

TEST(DrawPlan, DrawsAnotherPlanBelow) {
  const test::TemporaryFolder folder;
  const test::PlannedExample example;
  PlanFigure other = example.figure;
  other.title = "the other";
  other.metrics.rmse = 0.7;
  const auto bytes_of = [&](const PlanFigure* beside) {
    draw_plan(example.figure, folder.file("a.png"), beside);
    return read_file(folder.file("a.png"));
  };
  const std::string alone = bytes_of(nullptr);
  const std::string both = bytes_of(&other);
  EXPECT_EQ(side_of(both, 0), side_of(alone, 0));
  EXPECT_GT(2 * side_of(both, 1), 3 * side_of(alone, 1));
  EXPECT_LT(side_of(both, 1), 2 * side_of(alone, 1));  // the table is drawn once

  // title, metrics, paths, trace and reconstruction are all visible
  Plan fewer = example.plan;
  fewer.paths.pop_back();
  PlanTrace shorter = example.trace;
  shorter.tour.pop_back();
  const std::vector<std::function<void(PlanFigure&)>> changes = {
      [](PlanFigure& f) { f.title += "!"; }, [](PlanFigure& f) { f.metrics.rmse += 0.1; },
      [&](PlanFigure& f) { f.plan = &fewer; }, [&](PlanFigure& f) { f.trace = &shorter; },
      [](PlanFigure& f) { f.reconstruction.assign(f.reconstruction.size(), 0.0); }};
  for (const auto& change : changes) {
    PlanFigure changed = other;
    change(changed);
    EXPECT_FALSE(bytes_of(&changed) == both);
  }

  // the table's controls are those of the first plan
  other.controls.clear();
  EXPECT_TRUE(bytes_of(&other) == both);
}

TEST(DrawPlan, DrawsDegenerateFields) {
  const test::TemporaryFolder folder;
  const auto draws = [&](int rows, int cols, bool skin, double pressure) {
    TargetField field;
    field.resize(rows, cols);
    field.cell = 5e-3;
    for (std::size_t i = 0; i < field.size() && skin; ++i) {
      field.skin[i] = 1;
      field.pressure[i] = pressure;
    }
    const test::PlannedExample example(field);
    draw_plan(example.figure, folder.file("a.png"));
    EXPECT_TRUE(read_file(folder.file("a.png")).find("IEND") != std::string::npos);
  };
  draws(1, 1, true, 3.0);
  draws(1, 1, false, 0.0);
  draws(20, 30, false, 0.0);
  draws(20, 30, true, 0.0);
  draws(20, 30, true, 1e150);
  draws(1, 60, true, 1.0);
  draws(60, 1, true, 1.0);
}

TEST(DrawPlan, RejectsInconsistentInput) {
  const test::PlannedExample example;
  PlanFigure figure = example.figure;
  figure.reconstruction.pop_back();
  EXPECT_THROW(draw_plan(figure, "a.png"), std::invalid_argument);
  figure = example.figure;
  figure.trace = nullptr;
  EXPECT_THROW(draw_plan(figure, "a.png"), std::invalid_argument);
  EXPECT_THROW(draw_plan(example.figure, "a.png", &figure), std::invalid_argument);
  EXPECT_THAT(test::input_error([&] { draw_plan(example.figure, "a.jpg"); }),
              HasSubstr("must end in .png, .svg or .pdf"));
}

TEST(DrawScene, DrawsNoneOneAndTwoHands) {
  const test::TemporaryFolder folder;
  const test::PlannedExample example;
  std::vector<std::string> pages;
  for (int patches = 0; patches <= 2; ++patches) {
    draw_scene(test::scene_example(example, patches), folder.file("a.png"));
    pages.push_back(read_file(folder.file("a.png")));
  }
  EXPECT_FALSE(pages[0] == pages[1]);
  EXPECT_FALSE(pages[1] == pages[2]);
}

TEST(DrawScene, ShowsEveryPartOfItsInput) {
  const test::TemporaryFolder folder;
  const test::PlannedExample example;
  const auto bytes_of = [&](const SceneFigure& figure) {
    draw_scene(figure, folder.file("a.png"));
    return read_file(folder.file("a.png"));
  };
  const SceneFigure scene = test::scene_example(example, 1);
  const std::string whole = bytes_of(scene);
  const std::vector<std::function<void(SceneFigure&)>> changes = {
      [](SceneFigure& f) { f.smoke.assign(f.smoke.size(), 0.0F); },
      [](SceneFigure& f) { f.hand.assign(f.hand.size(), 0); },
      [](SceneFigure& f) { f.foci.clear(); },
      [](SceneFigure& f) { f.array.pop_back(); },
      [](SceneFigure& f) { f.plan.paths.pop_back(); },
      [](SceneFigure& f) { f.targets[0].X_DP.translation().x() += 0.02; },
      [](SceneFigure& f) { f.targets[0].X_DP.translation().z() += 0.02; },
      [](SceneFigure& f) { f.reconstructions[0].assign(f.reconstructions[0].size(), 0.0); }};
  for (const auto& change : changes) {
    SceneFigure changed = scene;
    change(changed);
    EXPECT_FALSE(bytes_of(changed) == whole);
  }
}

TEST(DrawScene, RejectsInconsistentInput) {
  const test::PlannedExample example;
  SceneFigure scene = test::scene_example(example, 1);
  scene.smoke.pop_back();
  EXPECT_THROW(draw_scene(scene, "a.png"), std::invalid_argument);
  scene = test::scene_example(example, 1);
  scene.reconstructions.clear();
  EXPECT_THROW(draw_scene(scene, "a.png"), std::invalid_argument);
  scene = test::scene_example(example, 1);
  scene.targets[0].X_DP.linear() = Eigen::AngleAxisd(kPi / 2.0, Vec3::UnitX()).toRotationMatrix();
  EXPECT_THROW(draw_scene(scene, "a.png"), std::invalid_argument);
}

TEST(Panel, HasOneScaleForBothAxesWithYUp) {
  const test::TemporaryFolder folder;
  figure::Canvas canvas(folder.file("a.png"), 100, 100);
  const figure::Panel panel(canvas, {10, 20, 60, 60}, {Vec2(-0.1, 0.0), Vec2(0.1, 0.1)});
  EXPECT_NEAR(panel.box().width, 60.0, 1e-9);
  EXPECT_NEAR(panel.box().height, 30.0, 1e-9);
  EXPECT_TRUE(panel.to_page(Vec2(-0.1, 0.0)).isApprox(Vec2(10, 50)));
  EXPECT_TRUE(panel.to_page(Vec2(0.1, 0.1)).isApprox(Vec2(70, 20)));
}

TEST(NumberText, HasAMinusSignAndNoNegativeZero) {
  EXPECT_EQ(figure::number_text(1.2345, 3), "1.234");
  EXPECT_EQ(figure::number_text(-0.5, 2), "−0.50");
  EXPECT_EQ(figure::number_text(-1e-9, 3), "0.000");
}

TEST(DrawPhysical, ShowsEveryPartOfItsInput) {
  const test::TemporaryFolder folder;
  const test::PlannedExample example;
  PhysicalField field;
  field.envelope = field.mean = example.figure.reconstruction;
  field.largest = 40.0;
  field.largest_mean = 40.0;
  FeltField felt;
  felt.percept = field.envelope;
  felt.largest = 1e-6;
  PhysicalFigure figure{&example.target, &example.plan, &field, &felt, true, "Skin", "felt 1"};
  const auto bytes = [&] {
    draw_physical(figure, folder.file("a.png"));
    return read_file(folder.file("a.png"));
  };
  const std::string whole = bytes();
  EXPECT_TRUE(whole == bytes());
  figure.has_target = false;  // two panels
  EXPECT_LT(bytes().size(), whole.size());
  figure.has_target = true;
  figure.summary = "felt 2";
  EXPECT_FALSE(bytes() == whole);
  figure.summary = "felt 1";
  field.envelope[400] += 20.0;
  EXPECT_FALSE(bytes() == whole);
  field.envelope = example.figure.reconstruction;
  felt.percept.assign(felt.percept.size(), 0.0);
  EXPECT_FALSE(bytes() == whole);
  figure.felt = nullptr;  // the mean instead of the percept
  const std::string without = bytes();
  field.mean.assign(field.mean.size(), 0.0);
  EXPECT_FALSE(bytes() == without);
  test::input_error([&] { draw_physical(figure, folder.file("a.gif")); });
}

}  // namespace
}  // namespace prostm
