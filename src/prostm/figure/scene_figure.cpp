/// One instant of the whole pipeline: the scene from the side, and the field on the skin.
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

constexpr Colour kAir{0.97, 0.975, 0.985}, kSmoke{0.27, 0.36, 0.52}, kHand{0.90, 0.70, 0.56},
    kArray{0.20, 0.22, 0.26}, kPlane{0.00, 0.45, 0.30};

// the page in points
constexpr double kTop = 84.0, kSideLeft = 62.0, kSideWidth = 470.0, kSideHeight = 560.0;
constexpr double kFieldLeft = 612.0, kFieldColumn = 330.0, kFieldWidth = 262.0;
constexpr double kBelowField = 84.0, kBelowSide = 80.0;
constexpr Box kSideSpace{kSideLeft, kTop, kSideWidth, kSideHeight};
constexpr double kUpright = 1e-3;  // smallest z component of a normal; below, the plane is upright

void check(const SceneFigure& f) {
  const auto cells =
      static_cast<std::size_t>(std::max(f.nx, 0)) * static_cast<std::size_t>(std::max(f.nz, 0));
  if (cells == 0 || f.smoke.size() != cells || f.hand.size() != cells || !(f.cell > 0.0)) {
    throw std::invalid_argument(
        fmt::format("a scene's slice of {} x {} cells has {} smoke and {} hand values; it must "
                    "have one each per "
                    "cell",
                    f.nx, f.nz, f.smoke.size(), f.hand.size()));
  }
  if (f.reconstructions.size() != f.targets.size()) {
    throw std::invalid_argument(fmt::format("a scene has {} reconstructions; it must have {}",
                                            f.reconstructions.size(), f.targets.size()));
  }
  for (std::size_t i = 0; i < f.targets.size(); ++i) {
    if (f.reconstructions[i].size() != f.targets[i].size()) {
      throw std::invalid_argument(
          "a reconstruction must have the same number of cells as its target");
    }
    if (std::abs(f.targets[i].X_DP(2, 2)) < kUpright) {
      throw std::invalid_argument("the plane of a target must not be upright");
    }
  }
}

/// Interpolates bilinearly between cell centres, clamped at the border.
template <class T>
double sample(const std::vector<T>& values, int nx, int nz, double x, double z) {
  x = std::clamp(x, 0.0, nx - 1.0);
  z = std::clamp(z, 0.0, nz - 1.0);
  const int i = std::min(static_cast<int>(x), std::max(nx - 2, 0));
  const int k = std::min(static_cast<int>(z), std::max(nz - 2, 0));
  const double s = x - i, t = z - k;
  const auto at = [&](int a, int b) {
    const auto index =
        static_cast<std::size_t>(std::min(b, nz - 1)) * static_cast<std::size_t>(nx) +
        static_cast<std::size_t>(std::min(a, nx - 1));
    return static_cast<double>(values[index]);
  };
  return (1.0 - t) * ((1.0 - s) * at(i, k) + s * at(i + 1, k)) +
         t * ((1.0 - s) * at(i, k + 1) + s * at(i + 1, k + 1));
}

figure::Extent side_extent(const SceneFigure& f) {
  const Vec2 half = Vec2::Constant(0.5 * f.cell);
  figure::Extent extent{f.origin - half, f.origin + f.cell * Vec2(f.nx - 1, f.nz - 1) + half};

  // leaves room below for the array
  constexpr double kMargin = 0.012;
  for (const Vec2& transducer : f.array) {
    extent.low = extent.low.cwiseMin(transducer - Vec2::Constant(kMargin));
    extent.high.x() = std::max(extent.high.x(), transducer.x() + kMargin);
  }
  return extent;
}

/// Draws smoke in front of the hand, with three drawn cells per cell for smooth outlines.
void draw_slice(Panel& panel, const SceneFigure& f, const figure::Extent& extent) {
  const double cell = f.cell / 3.0;
  const Vec2 size = extent.high - extent.low;
  const int cols = std::max(1, static_cast<int>(std::lround(size.x() / cell)));
  const int rows = std::max(1, static_cast<int>(std::lround(size.y() / cell)));
  panel.cells(rows, cols, [&](int row, int col) {
    const Vec2 x = extent.low + Vec2(size.x() * (col + 0.5) / cols, size.y() * (row + 0.5) / rows);
    const Vec2 u = (x - f.origin) / f.cell;
    const bool outside = u.x() < -0.5 || u.y() < -0.5 || u.x() > f.nx - 0.5 || u.y() > f.nz - 0.5;
    if (outside) return kAir;
    const double smoke = std::clamp(sample(f.smoke, f.nx, f.nz, u.x(), u.y()), 0.0, 1.0);
    const bool is_hand = sample(f.hand, f.nx, f.nz, u.x(), u.y()) > 0.5;
    return figure::mix(is_hand ? kHand : kAir, kSmoke, (is_hand ? 0.55 : 0.92) * smoke);
  });
}

/// The point of a target's plane above the middle of the array, in the plane's coordinates: the
/// zero of its axes, like that of the scene.
Vec2 above_array(const TargetField& target) {
  const Eigen::Matrix2d axes = target.X_DP.linear().topLeftCorner<2, 2>();
  return axes.inverse() * -target.X_DP.translation().head<2>();
}

/// Draws the raster of a target from the side, with the name of its x axis at the axis' end.
void draw_plane(Canvas& canvas, const Panel& panel, const TargetField& target) {
  const figure::Extent e = figure::extent_of(target);
  const auto from_side = [&](double x, double y) {
    const Vec3 p_D = target.X_DP * Vec3(x, y, 0.0);
    return panel.to_page(Vec2(p_D.x(), p_D.z()));
  };
  const std::array<Vec2, 4> corners{
      from_side(e.low.x(), e.low.y()), from_side(e.high.x(), e.low.y()),
      from_side(e.high.x(), e.high.y()), from_side(e.low.x(), e.high.y())};
  canvas.line(corners, true, kPlane, 1.4);
  canvas.text(0.5 * (corners[1] + corners[2]) + Vec2(5.0, 4.0), "x′",
              {.size = 11.5, .colour = kPlane, .bold = true});
}

/// Explains the colours of the side view in a line under it.
void draw_legend(Canvas& canvas, const Box& box) {
  struct Entry {
    const char* name;
    Colour colour;
    bool round;
  };
  const Entry entries[] = {{"smoke", kSmoke, false},
                           {"hand", kHand, false},
                           {"focal points", figure::kWarning, true},
                           {"plane of the target", kPlane, false},
                           {"array", kArray, false}};
  double x = box.x;
  const double y = box.y + box.height + 54.0;
  for (const Entry& entry : entries) {
    if (entry.round) {
      canvas.disc(Vec2(x + 5.5, y - 4.5), 3.0, entry.colour);
    } else {
      canvas.fill({x, y - 10.0, 11.0, 11.0}, entry.colour);
    }
    canvas.text(Vec2(x + 17.0, y), entry.name, {.size = 11.5});
    x += 38.0 + canvas.text_width(entry.name, {.size = 11.5});
  }
}

void draw_side(Canvas& canvas, const SceneFigure& f) {
  const figure::Extent extent = side_extent(f);
  Panel panel(canvas, kSideSpace, extent);
  draw_slice(panel, f, extent);

  // the array: one mark for each column of transducers
  const double mark = std::max(2.0, 0.008 * panel.scale());
  for (const Vec2& transducer : f.array) {
    const Vec2 at = panel.to_page(transducer);
    canvas.fill({at.x() - 0.5 * mark, at.y(), mark, 0.5 * mark}, kArray);
  }
  canvas.clip(panel.box());
  for (const TargetField& target : f.targets) draw_plane(canvas, panel, target);
  for (const Vec3& focus : f.foci) panel.disc(Vec2(focus.x(), focus.z()), 1.8, figure::kWarning);
  canvas.unclip();
  panel.axes({.title = "the scene from the side", .y_label = "z / mm"});
  draw_legend(canvas, panel.box());
}

/// The space for the target of patch `i`; the reconstruction is one column to the right.
Box field_space(const SceneFigure& f, std::size_t i) {
  const double count = static_cast<double>(f.targets.size());
  const double height = (kSideHeight - (count - 1.0) * kBelowField) / count;
  return {kFieldLeft, kTop + static_cast<double>(i) * (height + kBelowField), kFieldWidth, height};
}

/// Draws target and reconstruction of each patch side by side, all on one scale.
void draw_fields(Canvas& canvas, const SceneFigure& f) {
  if (f.targets.empty()) {
    canvas.text(Vec2(kFieldLeft, kTop + 20.0), "no hand in the smoke",
                {.size = 13.0, .colour = figure::kFaintInk});
    return;
  }
  canvas.text(
      Vec2(kFieldLeft - 36.0, kTop - 30.0),
      "x′ and y′ run along the plane of the target, from the point above the array's middle",
      {.size = 11.5, .colour = figure::kFaintInk});
  double full = 0.0;
  for (const TargetField& target : f.targets) full = std::max(full, max_pressure(target));
  for (std::size_t i = 0; i < f.targets.size(); ++i) {
    const std::string hand = f.targets.size() > 1 ? fmt::format(", hand {}", i + 1) : std::string();
    const figure::Extent extent = figure::extent_of(f.targets[i]);
    const Vec2 zero = above_array(f.targets[i]);
    const auto text = [&](const std::string& title) {
      return figure::PanelText{title + hand, "x′ / mm", "y′ / mm", zero};
    };
    Box space = field_space(f, i);
    Panel target(canvas, space, extent);
    target.heat_map(f.targets[i], f.targets[i].pressure, full);
    target.axes(text("target pressure"));
    space.x += kFieldColumn;
    Panel drawn(canvas, space, extent);
    drawn.heat_map(f.targets[i], f.reconstructions[i], full);
    drawn.plan_on_field(f.plan, static_cast<int>(i));
    drawn.axes(text(f.plan.foci.empty() ? "reconstruction and paths" : "reconstruction and foci"));
    const Box& box = drawn.box();
    figure::colour_bar(canvas, {box.x + box.width + 9.0, box.y, 11.0, box.height}, "p / max p*");
  }
}

/// The height of the page, depending on its content.
double page_height(const SceneFigure& f) {
  const Box side = figure::fitted(kSideSpace, side_extent(f));
  double bottom = side.y + side.height + kBelowSide;
  for (std::size_t i = 0; i < f.targets.size(); ++i) {
    const Box field = figure::fitted(field_space(f, i), figure::extent_of(f.targets[i]));
    bottom = std::max(bottom, field.y + field.height + 0.7 * kBelowField);
  }
  return bottom;
}

}  // namespace

void draw_scene(const SceneFigure& f, const std::string& path) {
  check(f);
  Canvas canvas(path, kFieldLeft + 2.0 * kFieldColumn + 30.0, page_height(f));
  canvas.text(Vec2(kSideLeft - 30.0, 38.0), f.title, {.size = 19.0, .bold = true});
  draw_side(canvas, f);
  draw_fields(canvas, f);
  canvas.save();
}

}  // namespace prostm
