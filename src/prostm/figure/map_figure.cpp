/// Maps over a plane, side by side, each with its own full scale.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "prostm/figure/detail/panel.hpp"
#include "prostm/figure/figures.hpp"

namespace prostm {
namespace {

using figure::Box;
using figure::Canvas;
using figure::Panel;

// the page in points
constexpr double kPanel = 170.0, kGap = 14.0, kAbove = 24.0, kBelow = 20.0;
constexpr double kMargin = 30.0, kTop = 66.0, kBar = 70.0;

void check(const MapFigure& maps) {
  if (maps.maps.empty() || maps.columns < 1) {
    throw std::invalid_argument("there must be at least one map and one column of maps");
  }
  for (const FieldMap& map : maps.maps) {
    if (map.rows > 0 && map.cols > 0 && map.cell > 0.0 &&
        map.values.size() ==
            static_cast<std::size_t>(map.rows) * static_cast<std::size_t>(map.cols)) {
      continue;
    }
    throw std::invalid_argument(
        fmt::format("the map '{}' has {} values; it must have one for each of its {} × {} cells",
                    map.title, map.values.size(), map.rows, map.cols));
  }
}

void draw_map(Canvas& canvas, const FieldMap& map, const Box& space) {
  TargetField field;
  field.resize(map.rows, map.cols);
  field.cell = map.cell;
  field.origin = -0.5 * map.cell * Vec2(map.cols - 1, map.rows - 1);
  std::fill(field.skin.begin(), field.skin.end(), std::uint8_t{1});
  double full = 0.0;
  for (const double value : map.values) full = std::max(full, value);

  Panel panel(canvas, space, figure::extent_of(field));
  panel.heat_map(field, map.values, full);
  if (!map.outline.empty()) panel.closed_line_on_field(map.outline);
  canvas.frame(panel.box(), figure::kInk, 0.6);
  canvas.text(Vec2(panel.box().x, panel.box().y - 7.0), map.title, {.size = 11.5, .bold = true});
  canvas.text(Vec2(panel.box().x, panel.box().y + panel.box().height + 14.0), map.note,
              {.size = 10.0, .colour = figure::kFaintInk});
}

}  // namespace

void draw_maps(const MapFigure& maps, const std::string& path) {
  check(maps);
  const auto columns = static_cast<std::size_t>(maps.columns);
  const std::size_t rows = (maps.maps.size() + columns - 1) / columns;
  double tallest = 0.0;  // largest height of a map over its width
  for (const FieldMap& map : maps.maps) {
    tallest = std::max(tallest, std::min(1.0, static_cast<double>(map.rows) / map.cols));
  }
  const double height = kAbove + tallest * kPanel + kBelow;
  const double right = kMargin + maps.columns * (kPanel + kGap);
  Canvas canvas(path, right + kBar, kTop + static_cast<double>(rows) * height + kMargin);
  canvas.text(Vec2(kMargin, 32.0), maps.title, {.size = 15.0, .bold = true});
  for (std::size_t i = 0; i < maps.maps.size(); ++i) {
    draw_map(canvas, maps.maps[i],
             {kMargin + static_cast<double>(i % columns) * (kPanel + kGap),
              kTop + static_cast<double>(i / columns) * height, kPanel, tallest * kPanel});
  }
  figure::colour_bar(canvas, {right + 4.0, kTop, 12.0, tallest * kPanel}, maps.scale);
  canvas.save();
}

}  // namespace prostm
