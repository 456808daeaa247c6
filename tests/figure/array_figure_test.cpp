#include <gtest/gtest.h>

#include <stdexcept>

#include "prostm/core/file/file.hpp"
#include "prostm/figure/figures.hpp"
#include "support/input_errors.hpp"

namespace prostm {
namespace {

ArrayFigure two_units() {
  ArrayFigure figure{"An array", {}, {}};
  for (int i = 0; i < 18; ++i) {
    figure.position.emplace_back(0.01 * (i % 9), 0.01 * (i / 9), 0.0);
    figure.unit.push_back(i / 9);
  }
  return figure;
}

TEST(DrawArray, ShowsEveryPartOfItsInput) {
  const test::TemporaryFolder folder;
  const auto bytes_of = [&](const ArrayFigure& figure) {
    draw_array(figure, folder.file("a.png"));
    return read_file(folder.file("a.png"));
  };
  const std::string whole = bytes_of(two_units());
  EXPECT_TRUE(whole == bytes_of(two_units()));
  const auto differs = [&](auto change) {
    ArrayFigure figure = two_units();
    change(figure);
    return bytes_of(figure) != whole;
  };
  EXPECT_TRUE(differs([](auto& f) { f.title = "Another"; }));
  EXPECT_TRUE(differs([](auto& f) { f.unit[3] = 1; }));
  EXPECT_TRUE(differs([](auto& f) { f.position[17].y() += 2e-3; }));
  EXPECT_TRUE(differs([](auto& f) { f.radius = 3e-3; }));
  // transducer 0 is marked
  EXPECT_TRUE(differs([](auto& f) { std::swap(f.position[0], f.position[1]); }));
}

TEST(DrawArray, RejectsInconsistentInput) {
  const test::TemporaryFolder folder;
  ArrayFigure figure = two_units();
  figure.unit.pop_back();
  EXPECT_THROW(draw_array(figure, folder.file("a.png")), std::invalid_argument);
  EXPECT_THROW(draw_array({}, folder.file("a.png")), std::invalid_argument);
}

}  // namespace
}  // namespace prostm
