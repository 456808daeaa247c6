/// The six panels of the paper's Fig. 2, and a table.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "prostm/figure/detail/panel.hpp"
#include "prostm/figure/figures.hpp"

namespace prostm {
namespace {

using figure::Align;
using figure::Box;
using figure::Canvas;
using figure::Colour;
using figure::Panel;

// the page in points: panels of at most 340 x 330 with room for axes and titles around them
constexpr double kPanelWidth = 340.0, kPanelHeight = 330.0, kColumn = 400.0;
constexpr double kLeft = 62.0, kTop = 84.0, kBelowPanel = 84.0, kRowHeight = 21.0;
constexpr double kBarRoom = 64.0;  // for the colour bar between the first two columns
constexpr double kPageWidth = kLeft + 3.0 * kColumn + kBarRoom + 34.0;
constexpr double kBetween = 56.0;  // gap between two plans, one above the other
constexpr double kFirstColumn = kLeft + 330.0, kColumnStep = 112.0;  // of the table

void check(const PlanFigure& f) {
  if (f.target == nullptr || f.plan == nullptr || f.trace == nullptr) {
    throw std::invalid_argument("a plan's figure must have a target, a plan and a trace");
  }
  if (f.reconstruction.size() != f.target->size()) {
    throw std::invalid_argument(
        fmt::format("the reconstruction has {} cells; it must have {}, like the target",
                    f.reconstruction.size(), f.target->size()));
  }
}

std::vector<Vec2> tour_points(const std::vector<Vec2>& clusters, const std::vector<int>& tour) {
  std::vector<Vec2> points;
  for (const int i : tour) points.push_back(clusters.at(static_cast<std::size_t>(i)));
  return points;
}

void draw_clusters(Panel& panel, const PlanTrace& trace) {
  const double heaviest = trace.cluster_mass.empty() ? 0.0
                                                     : *std::max_element(trace.cluster_mass.begin(),
                                                                         trace.cluster_mass.end());
  for (std::size_t i = 0; i < trace.clusters.size(); ++i) {
    const double share = heaviest > 0.0 ? trace.cluster_mass[i] / heaviest : 0.0;
    panel.disc(trace.clusters[i], 2.0 + 5.0 * std::sqrt(share), figure::kPaper);
    panel.disc(trace.clusters[i], 1.2 + 5.0 * std::sqrt(share), figure::field_colour(share));
  }
}

void draw_tour(Panel& panel, const PlanTrace& trace, const std::vector<int>& tour,
               const Colour& colour) {
  const std::vector<Vec2> points = tour_points(trace.clusters, tour);
  panel.closed_line(points, colour, 1.6);
  for (const Vec2& x : points) panel.disc(x, 2.4, colour);
}

/// Writes a value for each path or focus in its colour, under the panel that shows them.
void write_values(Canvas& canvas, const Panel& panel, const std::vector<std::string>& values,
                  const std::string& unit) {
  const figure::TextStyle plain{.size = 11.0, .bold = true};
  std::vector<std::string> texts;
  double width = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    texts.push_back(values[i] + (i + 1 < values.size() ? " · " : unit));
    width += canvas.text_width(texts.back(), plain);
  }
  const Box& box = panel.box();
  Vec2 at(box.x + 0.5 * (box.width - width), box.y + box.height + 50.0);
  for (std::size_t i = 0; i < texts.size(); ++i) {
    figure::TextStyle style = plain;
    style.colour = figure::path_colour(i);
    canvas.text(at, texts[i], style);
    at.x() += canvas.text_width(texts[i], plain);
  }
}

/// Makes panel `index` of three columns and two rows, with the first row at `top`.
Panel panel_at(Canvas& canvas, const TargetField& target, int index, double top) {
  const figure::Extent extent = figure::extent_of(target);
  const int column = index % 3;
  const double x = kLeft + kColumn * column + (column > 0 ? kBarRoom : 0.0);
  const double height = figure::fitted({0.0, 0.0, kPanelWidth, kPanelHeight}, extent).height;
  const double y = top + (index / 3) * (height + kBelowPanel);
  return {canvas, {x, y, kPanelWidth, kPanelHeight}, extent};
}

/// Whether the plan has the paper's steps, which have their own panels.
bool has_steps(const PlanFigure& f) {
  return !f.trace->clusters.empty();
}

/// Draws the panels with fields: the first and the last, on one scale.
void draw_field_panels(Canvas& canvas, const PlanFigure& f, double top) {
  const double full = max_pressure(*f.target);
  Panel target = panel_at(canvas, *f.target, 0, top);
  target.heat_map(*f.target, f.target->pressure, full);
  target.axes({.title = "(a) target pressure"});
  Panel reconstruction = panel_at(canvas, *f.target, has_steps(f) ? 5 : 2, top);
  reconstruction.heat_map(*f.target, f.reconstruction, full);
  reconstruction.axes({.title = has_steps(f)           ? "(f) reconstruction, Eq. (1)"
                                : f.plan->foci.empty() ? "(c) reconstruction, Eq. (1)"
                                                       : "(c) reconstruction, nearest focus"});
  for (const Panel* panel : {&target, &reconstruction}) {
    const Box& box = panel->box();
    figure::colour_bar(canvas, {box.x + box.width + 9.0, box.y, 11.0, box.height}, "p / max p*");
  }
}

/// Draws the paths, with their lengths.
void draw_paths_panel(Canvas& canvas, const PlanFigure& f, double top) {
  Panel panel = panel_at(canvas, *f.target, has_steps(f) ? 4 : 1, top);
  panel.silhouette(*f.target);
  for (std::size_t i = 0; i < f.plan->paths.size(); ++i) {
    const auto& points = f.plan->paths[i].points;
    panel.closed_line({points.data(), points.size()}, figure::path_colour(i), 2.4);
  }
  panel.axes({.title = has_steps(f) ? "(e) refined paths" : "(b) paths"});
  std::vector<std::string> lengths;
  for (const FocalPath& path : f.plan->paths)
    lengths.push_back(fmt::format("{:.1f}", 1e3 * path.length));
  write_values(canvas, panel, lengths, " mm");
}

/// Draws the foci, with areas proportional to their pressures, and the pressures.
void draw_foci_panel(Canvas& canvas, const PlanFigure& f, double top) {
  Panel panel = panel_at(canvas, *f.target, 1, top);
  panel.silhouette(*f.target);
  const double full = max_pressure(*f.target);
  std::vector<std::string> pressures;
  for (std::size_t i = 0; i < f.plan->foci.size(); ++i) {
    const FocalPoint& focus = f.plan->foci[i];
    const double share = focus.pressure / full;
    panel.disc(focus.position, 9.0 * std::sqrt(std::min(share, 4.0)), figure::path_colour(i));
    pressures.push_back(fmt::format("{:.2f}", share));
  }
  panel.axes({.title = "(b) foci"});
  write_values(canvas, panel, pressures, " max p*");
}

/// Draws the panels with the steps of planning: (b) to (d).
void draw_step_panels(Canvas& canvas, const PlanFigure& f, double top) {
  const PlanTrace& trace = *f.trace;
  for (int index = 1; index <= 3; ++index) {
    Panel panel = panel_at(canvas, *f.target, index, top);
    panel.silhouette(*f.target);
    if (index == 1) {
      draw_clusters(panel, trace);
      panel.axes({.title = fmt::format("(b) {} clusters", trace.clusters.size())});
    } else if (index == 2) {
      draw_tour(panel, trace, trace.tour, figure::kInk);
      panel.axes({.title = "(c) initial tour"});
    } else {
      for (std::size_t i = 0; i < trace.split.size(); ++i) {
        draw_tour(panel, trace, trace.split[i], figure::path_colour(i));
      }
      panel.axes({.title = "(d) split tours"});
    }
  }
}

struct TableRow {
  std::string name;
  const Metrics* metrics;
  bool is_control;
};

/// The metrics available in at least one row.
std::vector<Quantity<Metrics>> columns_of(const std::vector<TableRow>& rows) {
  std::vector<Quantity<Metrics>> columns;
  for (const Quantity<Metrics>& metric : quantities<Metrics>()) {
    const auto knows = [&](const TableRow& row) {
      return std::isfinite(value_of(metric, *row.metrics));
    };
    if (std::any_of(rows.begin(), rows.end(), knows)) columns.push_back(metric);
  }
  return columns;
}

/// Draws one row; a control's value that is better than `own`, in the printed digits, has the
/// warning colour.
void draw_row(Canvas& canvas, const TableRow& row, const std::vector<Quantity<Metrics>>& columns,
              const Metrics& own, double y) {
  const bool bold = !row.is_control;
  canvas.text(Vec2(kLeft - 24.0, y), row.name, {.size = 12.0, .bold = bold});
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const double value = value_of(columns[c], *row.metrics), best = value_of(columns[c], own);
    const bool known = row.is_control && std::isfinite(value) && std::isfinite(best);
    const bool better = columns[c].better == Better::Less ? value < best : value > best;
    const bool wins =
        known && better && figure::number_text(value, 3) != figure::number_text(best, 3);
    canvas.text(Vec2(kFirstColumn + kColumnStep * (static_cast<double>(c) + 0.5), y),
                std::isfinite(value) ? figure::number_text(value, 3) : "–",
                {.size = 12.0,
                 .colour = wins ? figure::kWarning : figure::kInk,
                 .align = Align::Right,
                 .bold = bold});
  }
}

/// Draws the plan's metrics above those of the plans that it is compared with.
void draw_table(Canvas& canvas, const std::vector<TableRow>& rows, double top) {
  const std::vector<Quantity<Metrics>> columns = columns_of(rows);
  const double right = kFirstColumn + kColumnStep * (static_cast<double>(columns.size()) - 0.15);
  const auto rule = [&](double y, double width) {
    const std::array<Vec2, 2> ends{Vec2(kLeft - 30.0, y), Vec2(right, y)};
    canvas.line(ends, false, figure::kInk, width);
  };
  rule(top, 1.2);
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const char* arrow = columns[c].better == Better::Less ? " ↓" : " ↑";
    canvas.text(Vec2(kFirstColumn + kColumnStep * (static_cast<double>(c) + 0.5), top + 16.0),
                columns[c].label + std::string(arrow),
                {.size = 11.5, .colour = figure::kFaintInk, .align = Align::Right});
  }
  rule(top + 23.0, 0.6);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    draw_row(canvas, rows[r], columns, *rows[0].metrics,
             top + 40.0 + kRowHeight * static_cast<double>(r));
  }
  rule(top + 26.0 + kRowHeight * static_cast<double>(rows.size()), 1.2);
}

}  // namespace

void draw_plan(const PlanFigure& f, const std::string& path, const PlanFigure* beside) {
  std::vector<const PlanFigure*> blocks{&f};
  if (beside != nullptr) blocks.push_back(beside);
  std::vector<TableRow> rows;
  for (const PlanFigure* block : blocks) {
    check(*block);
    rows.push_back({block == &f ? "this plan" : block->title, &block->metrics, false});
  }
  for (const Control& c : f.controls) rows.push_back({"control: " + c.name, &c.metrics, true});

  // the height of the page depends on the panels and the table
  const Box panel =
      figure::fitted({0.0, 0.0, kPanelWidth, kPanelHeight}, figure::extent_of(*f.target));
  const auto height_of = [&](const PlanFigure& block) {
    return (has_steps(block) ? 2.0 : 1.0) * (panel.height + kBelowPanel);
  };
  double table_top = kTop - 6.0 - kBetween;
  for (const PlanFigure* block : blocks) table_top += height_of(*block) + kBetween;
  Canvas canvas(path, kPageWidth, table_top + 49.0 + kRowHeight * static_cast<double>(rows.size()));
  double top = kTop;
  for (const PlanFigure* block : blocks) {
    canvas.text(Vec2(kLeft - 30.0, top - 46.0), block->title, {.size = 19.0, .bold = true});
    draw_field_panels(canvas, *block, top);
    if (block->plan->foci.empty()) {
      draw_paths_panel(canvas, *block, top);
    } else {
      draw_foci_panel(canvas, *block, top);
    }
    if (has_steps(*block)) draw_step_panels(canvas, *block, top);
    top += height_of(*block) + kBetween;
  }
  draw_table(canvas, rows, table_top);
  canvas.save();
}

}  // namespace prostm
