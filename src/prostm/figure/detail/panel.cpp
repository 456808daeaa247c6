#include "prostm/figure/detail/panel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace prostm::figure {
namespace {

/// Calls tick(value in mm) for each multiple of the step within the range [m].
template <class Tick>
void for_each_tick(double low, double high, double length, const Tick& tick) {
  const double step = tick_step(1e3 * (high - low), std::clamp(length / 55.0, 1.0, 8.0));
  const double first = std::ceil(1e3 * low / step), last = std::floor(1e3 * high / step);
  constexpr int kMostTicks = 20;  // a bound, in case rounding makes the range vanish
  for (int i = 0; i < kMostTicks && first + i <= last; ++i) tick((first + i) * step);
}

constexpr double kTick = 4.0, kLabelSize = 10.5;

}  // namespace

double tick_step(double range, double wanted) {
  const double rough = range / wanted;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough) return factor * power;
  }
  return 10.0 * power;
}

std::string tick_text(double value) {
  std::string text = fmt::format("{:.10g}", value + 0.0);  // −0 becomes 0
  if (text.front() == '-') text.replace(0, 1, "−");
  return text;
}

Extent extent_of(const TargetField& field) {
  const Vec2 half = Vec2::Constant(0.5 * field.cell);
  return {field.origin - half, field.position(field.rows - 1, field.cols - 1) + half};
}

Box fitted(const Box& space, const Extent& extent) {
  const Vec2 size = extent.high - extent.low;
  const double scale = std::min(space.width / size.x(), space.height / size.y());
  return {space.x + 0.5 * (space.width - scale * size.x()), space.y, scale * size.x(),
          scale * size.y()};
}

std::string number_text(double value, int decimals) {
  std::string text = fmt::format("{:.{}f}", value, decimals);
  if (text.front() != '-') return text;
  const bool is_zero = text.find_first_not_of("-0.") == text.npos;
  return (is_zero ? "" : "−") + text.substr(1);
}

Panel::Panel(Canvas& canvas, const Box& space, const Extent& extent)
    : canvas_(canvas),
      extent_(extent),
      box_(fitted(space, extent)),
      scale_(box_.width / (extent.high.x() - extent.low.x())) {}

Vec2 Panel::to_page(const Vec2& x) const {
  return {box_.x + scale_ * (x.x() - extent_.low.x()),
          box_.y + box_.height - scale_ * (x.y() - extent_.low.y())};
}

void Panel::cells(int rows, int cols, const std::function<Colour(int row, int col)>& colour) {
  canvas_.cells(box_, rows, cols, colour);
}

void Panel::heat_map(const TargetField& field, const std::vector<double>& values, double full) {
  cells(field.rows, field.cols, [&](int row, int col) {
    const std::size_t i = field.index(row, col);
    if (field.skin[i] == 0) return kNoSkin;
    return field_colour(full > 0.0 ? std::min(values[i] / full, 1.0) : 0.0);
  });
}

void Panel::silhouette(const TargetField& field) {
  cells(field.rows, field.cols,
        [&](int row, int col) { return field.skin[field.index(row, col)] != 0 ? kSkin : kPaper; });
}

void Panel::closed_line(std::span<const Vec2> points, const Colour& colour, double line_width) {
  std::vector<Vec2> page(points.size());
  std::transform(points.begin(), points.end(), page.begin(),
                 [&](const Vec2& x) { return to_page(x); });
  canvas_.clip(box_);
  canvas_.line(page, true, colour, line_width);

  // an arrowhead in the middle of the longest segment
  std::size_t longest = 0;
  double length = 0.0;
  for (std::size_t i = 0; i < page.size(); ++i) {
    const double l = (page[(i + 1) % page.size()] - page[i]).norm();
    if (l > length) {
      length = l;
      longest = i;
    }
  }
  if (length > 0.0) {
    const Vec2 a = page[longest], b = page[(longest + 1) % page.size()];
    const Vec2 along = (b - a) / length, across(-along.y(), along.x());
    const Vec2 middle = 0.5 * (a + b);
    const double size = 2.2 + 1.6 * line_width;
    canvas_.triangle(middle + size * along, middle - size * (along - 0.8 * across),
                     middle - size * (along + 0.8 * across), colour);
  }
  canvas_.unclip();
}

void Panel::closed_line_on_field(std::span<const Vec2> points) {
  closed_line(points, kInk, 3.0);
  closed_line(points, kPaper, 1.6);
}

void Panel::plan_on_field(const Plan& plan, int patch) {
  for (const FocalPath& path : plan.paths) {
    if (path.patch != patch) continue;
    closed_line_on_field({path.points.data(), path.points.size()});
  }
  for (const FocalPoint& focus : plan.foci) {
    if (focus.patch != patch) continue;
    disc(focus.position, 4.4, kInk);
    disc(focus.position, 3.2, kPaper);
  }
}

void Panel::disc(const Vec2& centre, double radius_points, const Colour& colour) {
  canvas_.disc(to_page(centre), radius_points, colour);
}

void Panel::ticks_x(double zero) {
  const double bottom = box_.y + box_.height;
  const double low = extent_.low.x() - zero, high = extent_.high.x() - zero;
  for_each_tick(low, high, box_.width, [&](double mm) {
    const double x = to_page(Vec2(zero + 1e-3 * mm, 0.0)).x();
    const std::array<Vec2, 2> tick{Vec2(x, bottom), Vec2(x, bottom + kTick)};
    canvas_.line(tick, false, kInk, 0.8);
    canvas_.text(Vec2(x, bottom + kTick + 11.0), tick_text(mm),
                 {.size = kLabelSize, .align = Align::Centre});
  });
}

void Panel::ticks_y(double zero) {
  const double low = extent_.low.y() - zero, high = extent_.high.y() - zero;
  for_each_tick(low, high, box_.height, [&](double mm) {
    const double y = to_page(Vec2(0.0, zero + 1e-3 * mm)).y();
    const std::array<Vec2, 2> tick{Vec2(box_.x - kTick, y), Vec2(box_.x, y)};
    canvas_.line(tick, false, kInk, 0.8);
    canvas_.text(Vec2(box_.x - kTick - 3.0, y + 0.36 * kLabelSize), tick_text(mm),
                 {.size = kLabelSize, .align = Align::Right});
  });
}

void Panel::axes(const PanelText& text) {
  canvas_.frame(box_, kInk, 0.8);
  ticks_x(text.zero.x());
  ticks_y(text.zero.y());
  const Vec2 middle(box_.x + 0.5 * box_.width, box_.y + 0.5 * box_.height);
  canvas_.text(Vec2(middle.x(), box_.y + box_.height + 31.0), text.x_label,
               {.size = kLabelSize, .colour = kFaintInk, .align = Align::Centre});
  canvas_.text(Vec2(box_.x - 36.0, middle.y()), text.y_label,
               {.size = kLabelSize, .colour = kFaintInk, .align = Align::Centre, .upwards = true});
  canvas_.text(Vec2(box_.x, box_.y - 9.0), text.title, {.size = 13.0, .bold = true});
}

void colour_bar(Canvas& canvas, const Box& box, const std::string& label) {
  constexpr int kSteps = 256;
  canvas.cells(box, kSteps, 1, [](int row, int) { return field_colour((row + 0.5) / kSteps); });
  canvas.frame(box, kInk, 0.8);
  for (int i = 0; i <= 4; ++i) {
    const double y = box.y + box.height * (1.0 - 0.25 * i);
    const std::array<Vec2, 2> tick{Vec2(box.x + box.width, y), Vec2(box.x + box.width + kTick, y)};
    canvas.line(tick, false, kInk, 0.8);
    canvas.text(Vec2(box.x + box.width + kTick + 3.0, y + 0.36 * kLabelSize),
                fmt::format("{:g}", 0.25 * i), {.size = kLabelSize});
  }
  canvas.text(Vec2(box.x + box.width + 46.0, box.y + 0.5 * box.height), label,
              {.size = kLabelSize, .colour = kFaintInk, .align = Align::Centre, .upwards = true});
}

}  // namespace prostm::figure
