/// Many targets, each next to the planners' plans of it.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "prostm/figure/detail/panel.hpp"
#include "prostm/figure/figures.hpp"

namespace prostm {
namespace {

using figure::Align;
using figure::Box;
using figure::Canvas;
using figure::Panel;

// the page in points
constexpr double kPanel = 158.0, kPanelGap = 7.0, kFieldGap = 34.0;
constexpr double kMargin = 34.0, kTop = 112.0, kAbove = 40.0, kBelow = 30.0, kRowGap = 8.0,
                 kNote = 18.0, kSecond = 14.0;
constexpr double kBar = 84.0;  // room for the colour bar on the right
constexpr double kCaption = 10.5;

void check(const std::vector<GalleryField>& fields) {
  if (fields.empty()) throw std::invalid_argument("a gallery must have at least one field");
  for (const GalleryField& field : fields) {
    if (field.plans.size() != fields.front().plans.size()) {
      throw std::invalid_argument(fmt::format(
          "the gallery's field '{}' has {} plans; it must have {}, like the first field",
          field.name, field.plans.size(), fields.front().plans.size()));
    }
    for (const GalleryPlan& plan : field.plans) {
      if (plan.rendered.size() == field.target.size()) continue;
      throw std::invalid_argument(
          fmt::format("the field of '{}' has {} cells; it must have {}, like the target", plan.name,
                      plan.rendered.size(), field.target.size()));
    }
  }
}

/// Draws a scale bar of 50 mm in the corner of a panel.
void draw_scale(Canvas& canvas, const Panel& panel) {
  constexpr double kLength = 0.050;
  const Box& box = panel.box();
  const Vec2 left(box.x + 9.0, box.y + box.height - 10.0);
  const Vec2 right = left + Vec2(kLength * panel.scale(), 0.0);
  const std::array<Vec2, 2> ends{left, right};
  canvas.line(ends, false, figure::kInk, 2.0);
  canvas.text(0.5 * (left + right) - Vec2(0.0, 5.0), "50 mm",
              {.size = 9.5, .align = Align::Centre});
}

void write_metrics(Canvas& canvas, const Box& box, const Metrics& m, GalleryCaption caption,
                   bool is_best) {
  const bool skill = caption == GalleryCaption::Skill;
  canvas.text(
      Vec2(box.x + 0.5 * box.width, box.y + box.height + 15.0),
      fmt::format("RMSE {} · {} {}", figure::number_text(m.rmse, 3), skill ? "S₈.₅" : "corr.",
                  figure::number_text(skill ? m.skill_8 : m.correlation, 3)),
      {.size = kCaption, .align = Align::Centre, .bold = is_best});
}

void write_second_caption(Canvas& canvas, const Box& box, const std::string& caption) {
  canvas.text(Vec2(box.x + 0.5 * box.width, box.y + box.height + 15.0 + kSecond), caption,
              {.size = kCaption, .align = Align::Centre});
}

/// Draws one field: its target, then its plans, from `corner` to the right.
void draw_field(Canvas& canvas, const GalleryField& field, GalleryCaption caption,
                const Vec2& corner) {
  const double full = max_pressure(field.target);
  double least = field.plans.empty() ? 0.0 : field.plans.front().metrics.rmse;
  for (const GalleryPlan& plan : field.plans) least = std::min(least, plan.metrics.rmse);
  canvas.text(corner - Vec2(0.0, 24.0), field.name, {.size = 14.0, .bold = true});

  for (std::size_t i = 0; i <= field.plans.size(); ++i) {
    const double x = corner.x() + static_cast<double>(i) * (kPanel + kPanelGap);
    Panel panel(canvas, {x, corner.y(), kPanel, kPanel}, figure::extent_of(field.target));
    const GalleryPlan* plan = i == 0 ? nullptr : &field.plans[i - 1];
    panel.heat_map(field.target, plan == nullptr ? field.target.pressure : plan->rendered, full);
    if (plan != nullptr) {
      panel.plan_on_field(plan->plan, 0);
      write_metrics(canvas, panel.box(), plan->metrics, caption,
                    caption == GalleryCaption::Skill && field.plans.size() > 1 &&
                        plan->metrics.rmse == least);
      write_second_caption(canvas, panel.box(), plan->second_caption);
    } else {
      draw_scale(canvas, panel);
    }
    canvas.frame(panel.box(), figure::kInk, 0.6);
    canvas.text(Vec2(panel.box().x, corner.y() - 7.0), plan == nullptr ? "target" : plan->name,
                {.size = kCaption, .colour = figure::kFaintInk});
  }
}

std::string explanation(const std::vector<GalleryField>& fields) {
  const auto stands = [](const GalleryPlan& plan) { return !plan.plan.foci.empty(); };
  const bool any_stands = std::any_of(fields.begin(), fields.end(), [&](const GalleryField& field) {
    return std::any_of(field.plans.begin(), field.plans.end(), stands);
  });
  const std::string pressure = "Pressure over the target's maximum, on the skin; the focal points ";
  return pressure + (any_stands ? "move along white lines or stay at white points."
                                : "move along the white lines.");
}

}  // namespace

void draw_gallery(const GalleryPage& page, const std::vector<GalleryField>& fields,
                  const std::string& path) {
  check(fields);
  const double top = kTop + (page.note.empty() ? 0.0 : kNote);
  const std::size_t in_row = std::min(page.fields_in_row, fields.size());
  const std::size_t rows = (fields.size() + in_row - 1) / in_row;
  const double field_width =
      static_cast<double>(fields.front().plans.size() + 1) * (kPanel + kPanelGap) - kPanelGap;
  // all panels are squares; fields keep their aspect ratio within them
  const bool has_second = std::ranges::any_of(fields, [](const GalleryField& field) {
    return std::ranges::any_of(
        field.plans, [](const GalleryPlan& plan) { return !plan.second_caption.empty(); });
  });
  const double row_height = kAbove + kPanel + kBelow + kRowGap + (has_second ? kSecond : 0.0);
  const double width = kMargin + static_cast<double>(in_row) * (field_width + kFieldGap) -
                       kFieldGap + kBar + kMargin;
  const double height = top - kAbove + static_cast<double>(rows) * row_height;

  Canvas canvas(path, width, height);
  canvas.text(Vec2(kMargin, 36.0), page.title, {.size = 20.0, .bold = true});
  canvas.text(Vec2(kMargin, 56.0), explanation(fields),
              {.size = 12.0, .colour = figure::kFaintInk});
  canvas.text(Vec2(kMargin, 56.0 + kNote), page.note, {.size = 12.0, .colour = figure::kFaintInk});
  for (std::size_t i = 0; i < fields.size(); ++i) {
    draw_field(canvas, fields[i], page.caption,
               Vec2(kMargin + static_cast<double>(i % in_row) * (field_width + kFieldGap),
                    top + static_cast<double>(i / in_row) * row_height));
  }
  figure::colour_bar(canvas, {width - kMargin - kBar + 22.0, top, 12.0, kPanel}, "p / max p*");
  canvas.save();
}

}  // namespace prostm
