/// An array seen from above: its units and transducers in the device's frame.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "prostm/figure/detail/panel.hpp"
#include "prostm/figure/figures.hpp"

namespace prostm {
namespace {

using figure::Align;
using figure::Canvas;
using figure::Panel;

// the page in points
constexpr double kLeft = 70.0, kTop = 84.0, kSide = 480.0, kRight = 30.0, kBelow = 96.0;
constexpr double kMargin = 0.015, kAxis = 0.030;  // margin around the array; length of an arrow [m]

void check(const ArrayFigure& f) {
  const bool sizes = !f.position.empty() && f.unit.size() == f.position.size();
  if (!sizes || !(f.radius > 0.0)) {
    throw std::invalid_argument(
        fmt::format("the picture of an array has {} transducers and {} unit numbers; it must have "
                    "the same number of both, at least one",
                    f.position.size(), f.unit.size()));
  }
}

/// The extent of all transducers and the origin.
figure::Extent extent_of(const ArrayFigure& f) {
  figure::Extent extent{Vec2::Zero(), Vec2::Zero()};
  for (const Vec3& p : f.position) {
    extent.low = extent.low.cwiseMin(p.head<2>());
    extent.high = extent.high.cwiseMax(p.head<2>());
  }
  const Vec2 margin = Vec2::Constant(kMargin + f.radius);
  extent.low -= margin;
  extent.high += margin;
  extent.high = extent.high.cwiseMax(Vec2::Constant(kAxis + kMargin));
  return extent;
}

/// An arrow from the origin along a unit vector.
void draw_axis(Canvas& canvas, const Panel& panel, const Vec2& along, const std::string& name) {
  const Vec2 from = panel.to_page(Vec2::Zero()), to = panel.to_page(kAxis * along);
  const Vec2 ahead = (to - from).normalized(), aside(-ahead.y(), ahead.x());
  const std::array<Vec2, 2> shaft{from, to};
  canvas.line(shaft, false, figure::kInk, 2.0);
  canvas.triangle(to + 9.0 * ahead, to + 4.0 * aside, to - 4.0 * aside, figure::kInk);
  canvas.text(to + 18.0 * ahead + Vec2(0.0, 4.0), name,
              {.size = 13.0, .colour = figure::kInk, .align = Align::Centre, .bold = true});
}

/// Marks transducer 0, with a label that is legible on other transducers.
void mark(Canvas& canvas, const Vec2& centre, double radius) {
  constexpr double kHeight = 14.0;
  const figure::TextStyle style{.size = 11.0, .bold = true};
  const std::string label = "transducer 0";
  canvas.disc(centre, 0.5 * radius, figure::kPaper);
  const Vec2 corner = centre + Vec2(-radius, radius + 3.0);
  canvas.fill({corner.x() - 2.0, corner.y(), canvas.text_width(label, style) + 4.0, kHeight},
              figure::kPaper);
  canvas.text(corner + Vec2(0.0, kHeight - 3.0), label, style);
}

}  // namespace

void draw_array(const ArrayFigure& f, const std::string& path) {
  check(f);
  const figure::Extent extent = extent_of(f);
  const figure::Box space = figure::fitted({kLeft, kTop, kSide, kSide}, extent);
  Canvas canvas(path, kLeft + kSide + kRight, kTop + space.height + kBelow);
  canvas.text(Vec2(kLeft, 32.0), f.title, {.size = 15.0, .bold = true});
  canvas.text(Vec2(kLeft, 50.0),
              "seen from above, in frame D: the hand is between the viewer and the array",
              {.size = 10.5, .colour = figure::kFaintInk});
  Panel panel(canvas, space, extent);
  const double radius = std::max(1.0, f.radius * panel.scale());
  for (std::size_t i = 0; i < f.position.size(); ++i) {
    const figure::Colour of_unit = figure::path_colour(static_cast<std::size_t>(f.unit[i]));
    const bool is_first = i == 0 || f.unit[i] != f.unit[i - 1];
    panel.disc(f.position[i].head<2>(), radius,
               is_first ? of_unit : figure::mix(of_unit, figure::kPaper, 0.6));
  }
  mark(canvas, panel.to_page(f.position.front().head<2>()), radius);
  draw_axis(canvas, panel, Vec2::UnitX(), "x");
  draw_axis(canvas, panel, Vec2::UnitY(), "y");
  panel.axes({.title = ""});
  const int units = 1 + *std::ranges::max_element(f.unit);
  canvas.text(Vec2(kLeft, kTop + space.height + 62.0),
              fmt::format("{} transducers in {} unit{}; transducer 0 of each unit is dark; the "
                          "arrows start at D's origin",
                          f.position.size(), units, units == 1 ? "" : "s"),
              {.size = 11.0});
  canvas.save();
}

}  // namespace prostm
