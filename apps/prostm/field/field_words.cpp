#include "field/field_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "field/quality_words.hpp"
#include "prostm/core/text/number_text.hpp"

namespace prostm::app {
namespace {

constexpr double kHandSpan = 0.250;   // length and width of a large hand, fingers spread [m]
constexpr double kHandWidth = 200.0;  // a size that fits on a hand, for advice [mm]

int skin_cells(const TargetField& field) {
  return static_cast<int>(std::count(field.skin.begin(), field.skin.end(), std::uint8_t{1}));
}

std::string skin_text(const TargetField& field) {
  const auto cells = static_cast<double>(field.size());
  const int skin = skin_cells(field);
  if (static_cast<double>(skin) == cells) return "all skin";
  return skin == 0 ? "no skin" : fmt::format("{:.0f} % skin", 100.0 * skin / cells);
}

std::string pressure_text(FieldKind kind, double largest, bool invert) {
  if (kind == FieldKind::Recording) return fmt::format("{:.3g} Pa", largest);
  if (kind != FieldKind::Png) return fmt::format("{:.3g} in the file's unit", largest);
  return fmt::format("{:.3g} of full scale, {} is full scale and {} is no pressure", largest,
                     invert ? "black" : "white", invert ? "white" : "black");
}

/// Width and height of the part of the raster that has skin [m].
Vec2 skin_size(const TargetField& field) {
  int left = field.cols, right = -1, low = field.rows, high = -1;
  for (int row = 0; row < field.rows; ++row) {
    for (int col = 0; col < field.cols; ++col) {
      if (field.skin[field.index(row, col)] == 0) continue;
      left = std::min(left, col);
      right = std::max(right, col);
      low = std::min(low, row);
      high = row;
    }
  }
  return field.cell * Vec2(std::max(right - left + 1, 0), std::max(high - low + 1, 0));
}

/// Returns the share of the raster's border cells with at least this share of the largest pressure.
double border_share(const TargetField& field, double carries) {
  const double least = carries * max_pressure(field);
  int border = 0, pressed = 0;
  for (int row = 0; row < field.rows; ++row) {
    for (int col = 0; col < field.cols; ++col) {
      const bool inside = row > 0 && row + 1 < field.rows && col > 0 && col + 1 < field.cols;
      if (inside) continue;
      const double p = field.pressure[field.index(row, col)];
      ++border;
      if (p > 0.0 && p >= least) ++pressed;
    }
  }
  return static_cast<double>(pressed) / std::max(border, 1);
}

/// Whether most of the border carries pressure.
bool presses_on_border(const TargetField& field) {
  return border_share(field, 0.25) > 0.5;
}

/// Whether nearly all of the border has full pressure, like the white paper of a drawing. The
/// border of a photo has shades.
bool is_on_paper(const TargetField& field) {
  return border_share(field, 0.9) >= 0.9;
}

/// Whether the pressure is the same on all skin: a flat field then renders it without an error.
bool is_even(const TargetField& field) {
  double least = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < field.size(); ++i) {
    if (field.skin[i] != 0) least = std::min(least, field.pressure[i]);
  }
  return least >= max_pressure(field);
}

/// Returns a warning for a picture that was probably not meant as it is read; else empty.
std::string picture_warning(const TargetField& field, bool invert) {
  const int skin = skin_cells(field);
  if (skin == 0) return "the picture is transparent everywhere, and transparent means no skin";
  if (is_even(field) && static_cast<std::size_t>(skin) == field.size())
    return "the picture is the same everywhere, so it has no shape to plan";
  const char* remedy = invert ? "try without --invert" : "try --invert";
  if (max_pressure(field) == 0.0) {
    return fmt::format(
        "the picture is {0} wherever it is not transparent, and {0} means no pressure; {1}, and "
        "fill the transparent background with {2} if it should be skin too",
        invert ? "white" : "black", remedy, invert ? "black" : "white");
  }
  if (is_even(field)) {
    return "the picture is the same wherever it is not transparent, so its shape lies only in its "
           "transparency, which means no skin; put it on a background without pressure";
  }
  if (!presses_on_border(field)) return {};
  if (!is_on_paper(field))
    return "most of the picture's border presses on the skin: brightness is pressure, so a photo "
           "presses nearly everywhere; remove its background (black, or transparent for no skin)";
  return fmt::format(
      "most of the picture's border presses on the skin, so it is probably drawn {}; {}",
      invert ? "white on black" : "black on white", remedy);
}

}  // namespace

std::string field_in_words(const std::string& path, FieldKind kind, const TargetField& field,
                           const FieldFileOptions& options) {
  const double cell_mm = 1e3 * field.cell;
  const bool one_of_many = kind == FieldKind::Recording || options.frame;
  const std::string frame =
      one_of_many ? fmt::format(", frame {}", options.frame.value_or(0)) : std::string();
  return fmt::format(
      "{}{}: {:.4g} × {:.4g} mm, {} × {} cells of {:.4g} mm, {}; largest pressure {}", path, frame,
      cell_mm * field.cols, cell_mm * field.rows, field.cols, field.rows, cell_mm, skin_text(field),
      pressure_text(kind, max_pressure(field), options.invert));
}

std::vector<std::string> field_warnings(FieldKind kind, const TargetField& field,
                                        const FieldFileOptions& options) {
  std::vector<std::string> warnings;
  const Vec2 size = skin_size(field);
  if (size.maxCoeff() > kHandSpan) {
    const bool sized_here = kind != FieldKind::Json && kind != FieldKind::Recording;
    const double width = kHandWidth * field.cols / std::max(field.cols, field.rows);
    warnings.push_back(fmt::format(
        "the field is {:.4g} × {:.4g} mm, larger than a hand{}", 1e3 * size.x(), 1e3 * size.y(),
        sized_here ? fmt::format("; try --width-mm {:.3g}", width) : std::string()));
  }
  if (kind != FieldKind::Png) return warnings;
  const std::string warning = picture_warning(field, options.invert);
  if (!warning.empty()) warnings.push_back(warning);
  return warnings;
}

void print_verdict(std::FILE* out, const TargetField& field, const Plan& plan,
                   const Metrics& played, const SensationInterval& interval,
                   const std::string& unfelt) {
  const bool stands = !plan.foci.empty();
  const std::size_t count = stands ? plan.foci.size() : plan.paths.size();
  const bool one = count == 1;
  const std::string what =
      fmt::format("{} {}", count, stands ? (one ? "focus" : "foci") : (one ? "path" : "paths"));
  const char* render = one ? "renders" : "render";
  if (is_even(field)) {
    fmt::print(
        out, "{} {} this even field with an error (RMSE) of {:.2f} of its pressure; 0 is perfect\n",
        what, render, played.rmse);
    print_sensation(out, played.sensation_level, interval);
    return;
  }
  fmt::print(out, "{} {} this field; a shape of 1 is perfect, 0 is no better than an even field\n",
             what, render);
  print_quality_numbers(out, played, interval, unfelt);
}

std::vector<std::string> control_warnings(const Metrics& played,
                                          const std::vector<Control>& controls, bool by_felt) {
  const auto best = std::max_element(
      controls.begin(), controls.end(),
      [](const auto& a, const auto& b) { return a.metrics.skill_0 < b.metrics.skill_0; });
  if (best == controls.end() || best->metrics.skill_0 <= played.skill_0) return {};
  const ComparedText text = compared_text(played.skill_0, best->metrics.skill_0, 2);
  return {fmt::format("the plan loses to the control \"{}\", shape by Eq. (1) {} against {}: {}",
                      best->name, text.value, text.bound,
                      by_felt ? "its pressure hardly resembles the field"
                              : "the percept will hardly resemble the field")};
}

void print_sensation(std::FILE* out, double level, const SensationInterval& interval) {
  if (std::isfinite(level)) fmt::print(out, "  felt strength: {}\n", level_words(level, interval));
}

}  // namespace prostm::app
