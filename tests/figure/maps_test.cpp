#include <gtest/gtest.h>

#include <stdexcept>

#include "prostm/core/file/file.hpp"
#include "prostm/figure/figures.hpp"
#include "support/input_errors.hpp"

namespace prostm {
namespace {

MapFigure figure_of(int count) {
  MapFigure figure{"Maps", "of the largest", 2, {}};
  for (int i = 0; i < count; ++i) {
    FieldMap map{"map " + std::to_string(i), "note", 3, 4, 2e-3, {}};
    for (int c = 0; c < 12; ++c) map.values.push_back(c * (i + 1));
    figure.maps.push_back(map);
  }
  return figure;
}

TEST(DrawMaps, ShowsEveryPartOfItsInput) {
  const test::TemporaryFolder folder;
  const auto bytes_of = [&](const MapFigure& figure) {
    draw_maps(figure, folder.file("a.png"));
    return read_file(folder.file("a.png"));
  };
  const std::string whole = bytes_of(figure_of(3));
  EXPECT_TRUE(whole == bytes_of(figure_of(3)));
  const auto differs = [&](auto change) {
    MapFigure figure = figure_of(3);
    change(figure);
    return bytes_of(figure) != whole;
  };
  EXPECT_TRUE(differs([](auto& f) { f.title = "Others"; }));
  EXPECT_TRUE(differs([](auto& f) { f.scale = "share"; }));
  EXPECT_TRUE(differs([](auto& f) { f.maps[2].title += "x"; }));
  EXPECT_TRUE(differs([](auto& f) { f.maps[1].note += "x"; }));
  EXPECT_TRUE(differs([](auto& f) { f.maps[2].values[5] = 1.0; }));
  EXPECT_TRUE(differs([](auto& f) {
    f.maps[0].outline = {Vec2(-2e-3, 0.0), Vec2(2e-3, 0.0), Vec2(0.0, 2e-3)};
  }));
}

TEST(DrawMaps, RejectsInconsistentInput) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("a.png");
  EXPECT_THROW(draw_maps(figure_of(0), path), std::invalid_argument);
  MapFigure figure = figure_of(2);
  figure.maps[1].values.pop_back();
  EXPECT_THROW(draw_maps(figure, path), std::invalid_argument);
  figure = figure_of(2);
  figure.columns = 0;
  EXPECT_THROW(draw_maps(figure, path), std::invalid_argument);
}

}  // namespace
}  // namespace prostm
