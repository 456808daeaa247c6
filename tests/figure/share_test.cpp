#include <cmath>

#include "prostm/core/file/file.hpp"
#include "prostm/figure/figures.hpp"
#include "prostm/io/field/field_file.hpp"
#include "support/input_errors.hpp"

namespace prostm {
namespace {

ShareFigure figure_of(std::size_t names, std::size_t groups, const std::string& name = "name") {
  ShareFigure out;
  out.title = "Right answers";
  out.y_label = "right answers / %";
  out.note = "A note";
  for (std::size_t i = 0; i < names; ++i) out.names.push_back(name + std::to_string(i));
  for (std::size_t g = 0; g < groups; ++g) {
    ShareGroup& group = out.groups.emplace_back();
    group.name = name;
    for (std::size_t i = 0; i < names; ++i) {
      group.bars.push_back({.share = 0.6, .low = 0.5, .high = 0.7, .dots = {0.4, 0.6, 0.6, 0.8}});
      for (std::size_t j = 0; j < i; ++j) group.brackets.push_back({j, i, {"p = 0.01", "p = 0.2"}});
    }
  }
  return out;
}

std::string bytes_of(const ShareFigure& figure, const std::string& ending = ".png") {
  const test::TemporaryFolder folder;
  draw_shares(figure, folder.file("a" + ending));
  return read_file(folder.file("a" + ending));
}

TEST(DrawShares, ShowsEveryPartOfItsInput) {
  const ShareFigure figure = figure_of(3, 2);
  const std::string whole = bytes_of(figure);
  EXPECT_TRUE(bytes_of(figure, ".svg").find("</svg>") != std::string::npos);
  EXPECT_TRUE(bytes_of(figure) == whole);
  const auto differs = [&](const auto& change) {
    ShareFigure other = figure;
    change(other);
    EXPECT_FALSE(bytes_of(other) == whole);
  };
  differs([](ShareFigure& f) { f.title = "Other"; });
  differs([](ShareFigure& f) { f.note = "Other"; });
  differs([](ShareFigure& f) { f.y_label = "Other"; });
  differs([](ShareFigure& f) { f.chance = 0.25; });
  differs([](ShareFigure& f) { f.names[2] = "other"; });
  differs([](ShareFigure& f) { f.groups[1].name = "other"; });
  differs([](ShareFigure& f) { f.groups[1].bars[0].share = 0.61; });
  differs([](ShareFigure& f) { f.groups[1].bars[0].low = 0.51; });
  differs([](ShareFigure& f) { f.groups[1].bars[0].high = 0.71; });
  differs([](ShareFigure& f) { f.groups[1].bars[0].dots[0] = 0.41; });
  differs([](ShareFigure& f) { f.groups[1].bars[0].dots.push_back(0.6); });
  differs([](ShareFigure& f) { f.groups[1].brackets.pop_back(); });
  differs([](ShareFigure& f) { f.groups[1].brackets[0].lines[1] = "p = 0.3"; });
}

/// Pixels that are not white.
int ink_of(const ShareFigure& figure) {
  const test::TemporaryFolder folder;
  draw_shares(figure, folder.file("a.png"));
  const TargetField page = read_field(folder.file("a.png"), {.cell_mm = 1.0});
  int ink = 0;
  for (const double grey : page.pressure) ink += grey < 0.99 ? 1 : 0;
  return ink;
}

// Dots at the same height are placed side by side: each adds as much ink as the first.
TEST(DrawShares, EqualDotsAreDrawnSideBySide) {
  ShareFigure figure = figure_of(1, 1);
  std::vector<double>& dots = figure.groups[0].bars[0].dots;
  const auto ink_with = [&](std::size_t count) {
    dots.assign(count, 0.85);  // on white paper, above the bar
    return ink_of(figure);
  };
  const int none = ink_with(0), one = ink_with(1) - none;
  EXPECT_GT(one, 30);
  for (const std::size_t count : {2U, 3U, 4U}) {
    const double expected = static_cast<double>(count) * one;
    EXPECT_NEAR(ink_with(count) - none, expected, 0.1 * expected);
  }
}

TEST(DrawShares, FitsOneBarAndManyWithLongNames) {
  const std::string name = "ein sehr langer Name für eine Szene, in der vier Strahlen blasen, ";
  for (const std::size_t names : {1U, 2U, 4U}) {
    for (const std::size_t groups : {1U, 6U}) {
      ShareFigure figure = figure_of(names, groups, name);
      for (ShareGroup& group : figure.groups) group.bars[0].dots.assign(60, 1.0);
      EXPECT_TRUE(bytes_of(figure, ".svg").find("</svg>") != std::string::npos);
    }
  }
}

TEST(DrawShares, RejectsInconsistentInput) {
  const auto refuses = [](const auto& change) {
    ShareFigure figure = figure_of(2, 2);
    change(figure);
    EXPECT_THROW(bytes_of(figure), std::invalid_argument);
  };
  refuses([](ShareFigure& f) { f.groups.clear(); });
  refuses([](ShareFigure& f) { f.names.clear(); });
  refuses([](ShareFigure& f) { f.names.pop_back(); });
  refuses([](ShareFigure& f) { f.chance = 1.5; });
  refuses([](ShareFigure& f) { f.groups[1].bars[1].share = std::nan(""); });
  refuses([](ShareFigure& f) { f.groups[1].bars[1].dots[0] = -0.1; });
  refuses([](ShareFigure& f) { f.groups[1].brackets[0].to = 2; });
  refuses([](ShareFigure& f) { f.groups[1].brackets[0].to = 0; });
}

}  // namespace
}  // namespace prostm
