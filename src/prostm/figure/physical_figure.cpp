/// Draws the pressure of an array on the skin and its percept, next to the target.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "prostm/figure/detail/panel.hpp"
#include "prostm/figure/figures.hpp"

namespace prostm {
namespace {

using figure::Box;
using figure::Canvas;
using figure::Colour;
using figure::Panel;

// the page in points
constexpr double kPanel = 270.0, kGap = 62.0, kLeft = 66.0, kTop = 96.0, kBelow = 62.0, kBar = 76.0;

/// Colour of a difference: blue (too little), white, red (too much).
Colour difference_colour(double t) {
  constexpr Colour kLess{0.13, 0.30, 0.62}, kMore{0.70, 0.12, 0.14};
  const double size = std::min(std::abs(t), 1.0);
  return figure::mix(figure::kPaper, t < 0.0 ? kLess : kMore, size);
}

void difference_bar(Canvas& canvas, const Box& box) {
  constexpr int kSteps = 256;
  canvas.cells(box, kSteps, 1,
               [](int row, int) { return difference_colour(2.0 * (row + 0.5) / kSteps - 1.0); });
  canvas.frame(box, figure::kInk, 0.8);
  for (int i = -1; i <= 1; ++i) {
    canvas.text(Vec2(box.x + box.width + 7.0, box.y + box.height * 0.5 * (1.0 - i) + 4.0),
                figure::number_text(i, 0), {.size = 11.0});
  }
  canvas.text(
      Vec2(box.x + box.width + 34.0, box.y + 0.5 * box.height), "difference / max p*",
      {.size = 11.0, .colour = figure::kFaintInk, .align = figure::Align::Centre, .upwards = true});
}

/// The difference of a field, scaled as for its score, and the target, over the target's maximum.
std::vector<double> differences(const TargetField& target, const std::vector<double>& field) {
  double with_target = 0.0, with_itself = 0.0;
  for (std::size_t c = 0; c < target.size(); ++c) {
    with_target += target.pressure[c] * field[c];
    with_itself += field[c] * field[c];
  }
  const double gain = with_itself > 0.0 ? with_target / with_itself : 0.0;
  const double full = std::max(max_pressure(target), 1e-300);
  std::vector<double> out(target.size());
  for (std::size_t c = 0; c < out.size(); ++c) {
    out[c] = (gain * field[c] - target.pressure[c]) / full;
  }
  return out;
}

class Page {
 public:
  Page(const PhysicalFigure& given, const std::string& path)
      : given_(given),
        panels_(given.has_target ? 4 : 2),
        extent_(figure::extent_of(*given.raster)),
        height_(figure::fitted({0.0, 0.0, kPanel, kPanel}, extent_).height),
        canvas_(path, kLeft + panels_ * (kPanel + kGap) + kBar * (panels_ > 2 ? 2 : 1),
                kTop + height_ + kBelow) {}

  void draw() {
    canvas_.text(Vec2(kLeft, 36.0), given_.title, {.size = 18.0, .bold = true});
    canvas_.text(Vec2(kLeft, 58.0), given_.summary, {.size = 12.0, .colour = figure::kFaintInk});
    if (given_.has_target) heat("target p*", given_.raster->pressure, max_pressure(*given_.raster));
    const PhysicalField& field = *given_.field;
    heat(fmt::format("radiation pressure, up to {} Pa", figure::number_text(field.largest, 1)),
         field.envelope, field.largest);
    if (const FeltField* felt = given_.felt; felt != nullptr) {
      heat(fmt::format("felt, up to {} µm", figure::number_text(1e6 * felt->largest, 2)),
           felt->percept, felt->largest);
    } else {
      heat(fmt::format("mean, up to {} Pa", figure::number_text(field.largest_mean, 2)), field.mean,
           field.largest_mean);
    }
    figure::colour_bar(canvas_, {next_ - kGap + 14.0, kTop, 12.0, height_}, "value / largest");
    if (given_.has_target) compare();
    canvas_.save();
  }

 private:
  Panel panel() { return {canvas_, {next_, kTop, kPanel, kPanel}, extent_}; }

  void finish(Panel& panel, const std::string& title) {
    panel.plan_on_field(*given_.plan, 0);
    panel.axes({.title = title});
    next_ += kPanel + kGap;
  }

  void heat(const std::string& title, const std::vector<double>& values, double full) {
    Panel p = panel();
    p.heat_map(*given_.raster, values, std::max(full, 1e-300));
    finish(p, title);
  }

  void compare() {
    if (given_.felt != nullptr) {
      difference("felt, scaled, − target", given_.felt->percept);
    } else {
      difference("pressure, scaled, − target", given_.field->envelope);
    }
  }

  void difference(const std::string& title, const std::vector<double>& field) {
    next_ += kBar;
    const TargetField& target = *given_.raster;
    const std::vector<double> values = differences(target, field);
    Panel p = panel();
    p.cells(target.rows, target.cols, [&](int row, int col) {
      const std::size_t c = target.index(row, col);
      return target.skin[c] != 0 ? difference_colour(values[c]) : figure::kNoSkin;
    });
    finish(p, title);
    difference_bar(canvas_, {next_ - kGap + 14.0, kTop, 12.0, height_});
  }

  const PhysicalFigure& given_;
  int panels_;
  figure::Extent extent_;
  double height_;
  Canvas canvas_;
  double next_ = kLeft;
};

}  // namespace

void draw_physical(const PhysicalFigure& given, const std::string& path) {
  Page(given, path).draw();
}

}  // namespace prostm
