/// Lines on logarithmic and linear axes.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "prostm/figure/detail/canvas.hpp"
#include "prostm/figure/detail/panel.hpp"
#include "prostm/figure/figures.hpp"

namespace prostm {
namespace {

using figure::Align;
using figure::Box;
using figure::Canvas;
using figure::Colour;

constexpr double kWidth = 430.0, kHeight = 320.0;  // of the drawing without axes [points]
constexpr double kLeft = 74.0, kRight = 118.0, kMostRight = 360.0, kTop = 52.0, kBottom = 58.0;
constexpr figure::TextStyle kName{.size = 11.5, .bold = true};
constexpr double kNameGap = 10.0;

/// One axis, which maps values to 0..1.
struct Axis {
  double low = 0.0, high = 1.0;
  bool logarithmic = true;
  double step = 0.0;  // between ticks, when linear

  double at(double value) const {
    return logarithmic ? std::log(value / low) / std::log(high / low)
                       : (value - low) / (high - low);
  }
};

Axis axis_of(double low, double high, bool logarithmic) {
  if (!logarithmic) {
    constexpr double kMargin = 0.08, kTicks = 9.0;
    if (low == high) return {low - 0.4, high + 0.4, false, 1.0};
    const double margin = kMargin * (high - low);
    return {low - margin, high + margin, false,
            figure::tick_step(high - low + 2.0 * margin, kTicks)};
  }
  // whole decades; a value may lie outside by 2 %
  const double from = std::floor(std::log10(low) + 0.01), to = std::ceil(std::log10(high) - 0.01);
  return {std::pow(10.0, from), std::pow(10.0, std::max(to, from + 1.0))};
}

std::string power_text(int exponent) {
  if (exponent >= 0 && exponent <= 3) return fmt::format("{:.0f}", std::pow(10.0, exponent));
  static constexpr std::array kDigits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = "10";
  if (exponent < 0) text += "⁻";
  for (const char digit : std::to_string(std::abs(exponent))) {
    text += kDigits[static_cast<std::size_t>(digit - '0')];
  }
  return text;
}

/// Draws one chart into a box.
class ChartDrawing {
 public:
  /// @param right width available for names to the right of the box.
  ChartDrawing(Canvas& canvas, const Chart& chart, const Box& box, double right)
      : canvas_(canvas), chart_(chart), box_(box), right_(right) {
    double low_x = HUGE_VAL, high_x = -HUGE_VAL, low_y = HUGE_VAL, high_y = -HUGE_VAL;
    const auto hold = [&](double x, double y) {
      low_x = std::min(low_x, x), high_x = std::max(high_x, x);
      low_y = std::min(low_y, y), high_y = std::max(high_y, y);
    };
    for (const ChartSeries& series : chart.series) {
      for (std::size_t k = 0; k < series.x.size(); ++k) hold(series.x[k], series.y[k]);
      for (const ChartDot& dot : series.dots) {
        hold(dot.x, dot.y);
        largest_ = std::max(largest_, dot.area);
      }
    }
    x_ = axis_of(low_x, high_x, chart.logarithmic_x);
    y_ = axis_of(low_y, high_y, chart.logarithmic_y);
  }

  void draw() {
    grid(x_, true);
    grid(y_, false);
    canvas_.clip(box_);
    slope();
    canvas_.unclip();
    canvas_.frame(box_, figure::kInk, 0.8);
    for (std::size_t i = 0; i < chart_.series.size(); ++i) dots(i);
    for (std::size_t i = 0; i < chart_.series.size(); ++i) line(i);
    for (std::size_t i = 0; i < chart_.series.size(); ++i) span(i);
    names();
    const Vec2 middle(box_.x + 0.5 * box_.width, box_.y + 0.5 * box_.height);
    canvas_.text(Vec2(middle.x(), box_.y + box_.height + 38.0), chart_.x_label,
                 {.size = 11.5, .align = Align::Centre});
    canvas_.text(Vec2(box_.x - 48.0, middle.y()), chart_.y_label,
                 {.size = 11.5, .align = Align::Centre, .upwards = true});
    const figure::TextStyle title{.size = 14.0, .bold = true};
    canvas_.text(Vec2(box_.x, box_.y - 14.0),
                 canvas_.shortened(chart_.title, box_.width + right_ - kNameGap, title), title);
  }

 private:
  Vec2 to_page(double x, double y) const {
    return {box_.x + box_.width * x_.at(x), box_.y + box_.height * (1.0 - y_.at(y))};
  }

  void tick(bool is_x, double value, const std::string& text) {
    const Vec2 at = is_x ? to_page(value, y_.low) : to_page(x_.low, value);
    const Vec2 across = is_x ? Vec2(0.0, -box_.height) : Vec2(box_.width, 0.0);
    const std::array<Vec2, 2> ends{at, at + across};
    canvas_.line(ends, false,
                 text.empty() ? figure::mix(figure::kPaper, figure::kNoSkin, 0.6) : figure::kSkin,
                 0.7);
    if (text.empty()) return;
    if (is_x) {  // with long numbers, omit some
      const double half = 0.5 * canvas_.text_width(text, {.size = 10.5}), kApart = 5.0;
      if (at.x() - half < tick_end_ + kApart) return;
      tick_end_ = at.x() + half;
    }
    canvas_.text(is_x ? Vec2(at + Vec2(0.0, 16.0)) : Vec2(at + Vec2(-7.0, 4.0)), text,
                 {.size = 10.5, .align = is_x ? Align::Centre : Align::Right});
  }

  void grid(const Axis& axis, bool is_x) {
    if (!axis.logarithmic) {
      const double first = std::ceil(axis.low / axis.step),
                   last = std::floor(axis.high / axis.step);
      constexpr int kMostTicks = 20;  // a bound, in case rounding makes the range vanish
      for (int i = 0; i < kMostTicks && first + i <= last; ++i)
        tick(is_x, (first + i) * axis.step, figure::tick_text((first + i) * axis.step));
      return;
    }
    const int first = static_cast<int>(std::lround(std::log10(axis.low)));
    const int last = static_cast<int>(std::lround(std::log10(axis.high)));
    for (int e = first; e < last; ++e) {
      for (int m = 2; m < 10; ++m) tick(is_x, m * std::pow(10.0, e), {});
    }
    for (int e = first; e <= last; ++e) tick(is_x, std::pow(10.0, e), power_text(e));
  }

  /// Draws the line y ∝ x, below all series.
  void slope() {
    if (!x_.logarithmic || !y_.logarithmic) return;
    double factor = HUGE_VAL;
    for (const ChartSeries& series : chart_.series) {
      for (std::size_t k = 0; k < series.x.size(); ++k) {
        factor = std::min(factor, 0.5 * series.y[k] / series.x[k]);
      }
    }
    const std::array<Vec2, 2> ends{to_page(x_.low, factor * x_.low),
                                   to_page(x_.high, factor * x_.high)};
    canvas_.line(ends, false, figure::kSkin, 2.2);
    const double x = x_.low * std::pow(x_.high / x_.low, 0.8);
    canvas_.text(to_page(x, factor * x) + Vec2(8.0, 14.0), "∝ x",
                 {.size = 11.5, .colour = figure::kFaintInk});
  }

  void line(std::size_t i) {
    const ChartSeries& series = chart_.series[i];
    std::vector<Vec2> page;
    for (std::size_t k = 0; k < series.x.size(); ++k) {
      page.push_back(to_page(series.x[k], series.y[k]));
    }
    canvas_.line(page, false, figure::path_colour(i), 2.0);
    if (!series.dots.empty()) return;
    for (const Vec2& at : page) {
      canvas_.disc(at, 4.2, figure::kPaper);
      canvas_.disc(at, 3.2, figure::path_colour(i));
    }
    labels(i, page);
  }

  void dots(std::size_t i) {
    constexpr double kLargest = 8.0;
    figure::Colour colour = figure::path_colour(i);
    colour.a = 0.5;
    for (const ChartDot& dot : chart_.series[i].dots)
      canvas_.disc(to_page(dot.x, dot.y), kLargest * std::sqrt(dot.area / largest_), colour);
  }

  /// Draws a span, shifted vertically so that it does not overlap those of other series.
  void span(std::size_t i) {
    if (!chart_.series[i].span) return;
    constexpr double kApart = 7.0, kEnd = 3.5;
    const ChartSpan& of = *chart_.series[i].span;
    const double middle = 0.5 * (static_cast<double>(chart_.series.size()) - 1.0);
    const Vec2 aside(0.0, kApart * (static_cast<double>(i) - middle)), end(0.0, kEnd);
    const auto at = [&](double x) {
      return Vec2(to_page(std::clamp(x, x_.low, x_.high), of.y) + aside);
    };
    const figure::Colour colour = figure::path_colour(i);
    const std::array<Vec2, 2> line{at(of.low), at(of.high)};
    canvas_.line(line, false, figure::kPaper, 4.5);
    canvas_.line(line, false, colour, 2.0);
    for (const double x : {of.low, of.high}) {
      if (x < x_.low || x > x_.high) continue;
      const std::array<Vec2, 2> across{at(x) - end, at(x) + end};
      canvas_.line(across, false, colour, 2.0);
    }
    canvas_.disc(at(of.value), 4.2, figure::kPaper);
    canvas_.disc(at(of.value), 3.2, colour);
  }

  /// Draws the label of each point above it, if there is room.
  void labels(std::size_t i, const std::vector<Vec2>& page) {
    constexpr double kAbove = 9.0, kLine = 11.0, kApart = 4.0;
    const ChartSeries& series = chart_.series[i];
    double taken_to = -HUGE_VAL, taken_at = 0.0;  // right end and height of the previous label
    for (std::size_t k = 0; k < series.labels.size(); ++k) {
      const figure::TextStyle style{
          .size = 10.5, .colour = figure::path_colour(i), .align = Align::Centre};
      const double half = 0.5 * canvas_.text_width(series.labels[k], style);
      const Vec2 at = page[k] - Vec2(0.0, kAbove);
      const bool beside = at.x() - half > taken_to + kApart;
      if (!beside && std::abs(at.y() - taken_at) < kLine) continue;
      canvas_.fill({at.x() - half, at.y() - kLine + 2.0, 2.0 * half, kLine}, figure::kPaper);
      canvas_.text(at, series.labels[k], style);
      taken_to = at.x() + half;
      taken_at = at.y();
    }
  }

  /// Draws each name at the right end of its line, moved apart if they would touch.
  void names() {
    constexpr double kSpacing = 15.0;
    std::vector<std::size_t> order(chart_.series.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto end_of = [&](std::size_t i) {
      const ChartSeries& of = chart_.series[i];
      return to_page(x_.low, of.y.empty() ? of.dots.back().y : of.y.back()).y();
    };
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return end_of(a) < end_of(b); });
    double lowest = box_.y - kSpacing;
    for (const std::size_t i : order) {
      const double y = std::max(end_of(i) + 4.0, lowest + kSpacing);
      figure::TextStyle style = kName;
      style.colour = figure::path_colour(i);
      canvas_.text(Vec2(box_.x + box_.width + kNameGap, y),
                   canvas_.shortened(chart_.series[i].name, right_ - 2.0 * kNameGap, style), style);
      lowest = y;
    }
  }

  Canvas& canvas_;
  const Chart& chart_;
  Box box_;
  double right_;
  double largest_ = 0.0;         // area of a dot
  double tick_end_ = -HUGE_VAL;  // right end of the last number below the box
  Axis x_, y_;
};

void check(const Chart& chart) {
  const auto good = [](const std::vector<double>& values, bool logarithmic) {
    return std::all_of(values.begin(), values.end(),
                       [&](double v) { return std::isfinite(v) && (!logarithmic || v > 0.0); });
  };
  if (chart.series.empty()) {
    throw std::invalid_argument("the chart '" + chart.title + "' must have at least one line");
  }
  for (const ChartSeries& series : chart.series) {
    std::vector<double> x = series.x, y = series.y;
    for (const ChartDot& dot : series.dots) x.push_back(dot.x), y.push_back(dot.y);
    if (x.empty() || series.x.size() != series.y.size() || !good(x, chart.logarithmic_x) ||
        !good(y, chart.logarithmic_y)) {
      throw std::invalid_argument(
          "the line '" + series.name +
          "' must have the same number of x and y, all finite, and positive on a "
          "logarithmic axis");
    }
    if (series.labels.empty() || series.labels.size() == series.x.size()) continue;
    throw std::invalid_argument("the line '" + series.name + "' must have a label for each point");
  }
}

}  // namespace

void draw_charts(const std::vector<Chart>& charts, const std::string& path, std::size_t in_row) {
  if (charts.empty()) throw std::invalid_argument("a figure must have at least one chart");
  for (const Chart& chart : charts) check(chart);
  const std::size_t columns = in_row == 0 ? charts.size() : std::min(in_row, charts.size());
  const std::size_t rows = (charts.size() + columns - 1) / columns;
  double right = kRight;
  Canvas ruler(path, 1.0, 1.0);
  for (const Chart& chart : charts) {
    for (const ChartSeries& series : chart.series)
      right = std::max(right, ruler.text_width(series.name, kName) + 2.0 * kNameGap);
  }
  right = std::min(right, kMostRight);
  const double width = kLeft + kWidth + right, height = kTop + kHeight + kBottom;
  Canvas canvas(path, width * static_cast<double>(columns), height * static_cast<double>(rows));
  for (std::size_t i = 0; i < charts.size(); ++i) {
    const double x = width * static_cast<double>(i % columns),
                 y = height * static_cast<double>(i / columns);
    ChartDrawing(canvas, charts[i], {x + kLeft, y + kTop, kWidth, kHeight}, right).draw();
  }
  canvas.save();
}

}  // namespace prostm
