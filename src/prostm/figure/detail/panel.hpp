#pragma once
/// One picture of a plane with axes in mm. Private to figure.

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
/// From edge to edge of the border cells.
Extent extent_of(const TargetField& field);

/// The largest box of the extent's shape in `space`: in its middle, at the top.
Box fitted(const Box& space, const Extent& extent);

/// A number as it stands on an axis or in a table: with a minus sign, and no zero that is negative.
std::string number_text(double value, int decimals);

/// The step of 1, 2 or 5 times a power of ten that makes about `wanted` ticks.
double tick_step(double range, double wanted);
/// A multiple of a step as it stands on an axis, without the rounding error of a sum of steps.
std::string tick_text(double value);

/// The text around a panel.
struct PanelText {
  std::string title;
  std::string x_label = "x / mm", y_label = "y / mm";
  Vec2 zero = Vec2::Zero();  ///< where both axes read 0, in the panel's plane [m]
};

class Panel {
 public:
  /// Fits the extent into `space`: the drawing alone, axes and title stand outside of it.
  Panel(Canvas& canvas, const Box& space, const Extent& extent);

  const Box& box() const { return box_; }
  Vec2 to_page(const Vec2& x) const;
  double scale() const { return scale_; }  ///< points for a metre

  /// `colour` of each cell of a raster that fills the extent.
  void cells(int rows, int cols, const std::function<Colour(int row, int col)>& colour);
  /// A field on the skin, `full` at the end of the colour map; cells without skin in light grey.
  void heat_map(const TargetField& field, const std::vector<double>& values, double full);
  void silhouette(const TargetField& field);
  /// A closed polygon with an arrow that shows its direction.
  void closed_line(std::span<const Vec2> points, const Colour& colour, double line_width);
  /// The same, legible on any colour.
  void closed_line_on_field(std::span<const Vec2> points);
  /// The paths and foci of a plan that lie on a patch, legible on any colour.
  void plan_on_field(const Plan& plan, int patch);
  void disc(const Vec2& centre, double radius_points, const Colour& colour);
  /// Frame, ticks, labels and title: drawn last.
  void axes(const PanelText& text);

 private:
  void ticks_x(double zero);
  void ticks_y(double zero);

  Canvas& canvas_;
  Extent extent_;
  Box box_;
  double scale_ = 1.0;
};

/// The colour map from 0 to 1 beside a panel.
void colour_bar(Canvas& canvas, const Box& box, const std::string& label);

}  // namespace prostm::figure
