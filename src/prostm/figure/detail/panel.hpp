#pragma once
/// A panel that shows a plane, with axes in mm. Private to figure.

#include <functional>
#include <string>

#include "prostm/figure/detail/canvas.hpp"
#include "prostm/plan/plan.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm::figure {

/// A rectangle of a plane [m].
struct Extent {
  Vec2 low = Vec2::Zero(), high = Vec2::Zero();
};
/// The extent of a field, including the border cells.
Extent extent_of(const TargetField& field);

/// The largest box with the extent's aspect ratio in `space`, horizontally centred, at the top.
Box fitted(const Box& space, const Extent& extent);

/// A number for an axis or a table, with a proper minus sign and without negative zero.
std::string number_text(double value, int decimals);

/// The step, 1, 2 or 5 times a power of ten, that gives about `wanted` ticks.
double tick_step(double range, double wanted);
/// The label of a tick, without the rounding error of a sum of steps.
std::string tick_text(double value);

/// The text around a panel.
struct PanelText {
  std::string title;
  std::string x_label = "x / mm", y_label = "y / mm";
  Vec2 zero = Vec2::Zero();  ///< point where both axes are 0, in the panel's plane [m]
};

class Panel {
 public:
  /// Fits the extent into `space`; axes and title are outside of it.
  Panel(Canvas& canvas, const Box& space, const Extent& extent);

  const Box& box() const { return box_; }
  Vec2 to_page(const Vec2& x) const;
  double scale() const { return scale_; }  ///< points per metre

  /// Draws a raster that fills the extent, with `colour` for each cell.
  void cells(int rows, int cols, const std::function<Colour(int row, int col)>& colour);
  /// Draws a field on the skin, with `full` at the end of the colour map and cells without skin in
  /// light grey.
  void heat_map(const TargetField& field, const std::vector<double>& values, double full);
  void silhouette(const TargetField& field);
  /// Draws a closed polygon with an arrow for its direction.
  void closed_line(std::span<const Vec2> points, const Colour& colour, double line_width);
  /// The same, legible on any background.
  void closed_line_on_field(std::span<const Vec2> points);
  /// Draws the paths and foci of a plan on a patch, legible on any background.
  void plan_on_field(const Plan& plan, int patch);
  void disc(const Vec2& centre, double radius_points, const Colour& colour);
  /// Draws frame, ticks, labels and title. Call it last.
  void axes(const PanelText& text);

 private:
  void ticks_x(double zero);
  void ticks_y(double zero);

  Canvas& canvas_;
  Extent extent_;
  Box box_;
  double scale_ = 1.0;
};

/// Draws the colour map from 0 to 1 next to a panel.
void colour_bar(Canvas& canvas, const Box& box, const std::string& label);

}  // namespace prostm::figure
