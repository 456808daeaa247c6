#pragma once
/// The target pressure as a smooth function of the plane, in the units of the planner's costs.

#include <array>
#include <cstddef>
#include <vector>

#include "prostm/core/geometry.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm::planning {

inline constexpr double kMmPerMetre = 1e3;

struct PressureSample {
  double value = 0.0;            ///< p*/max p*; Catmull-Rom overshoots, so it may leave [0, 1]
  Vec2 gradient = Vec2::Zero();  ///< [1/mm]
};

/// p* over the frame's maximum, interpolated by Catmull-Rom bicubics (P8), zero off the skin and
/// off the raster. Coordinates are millimetres from the centre of cell (0, 0).
class PressureRaster {
 public:
  explicit PressureRaster(std::size_t max_cells) { value_.reserve(max_cells); }

  /// Copies p*/maximum of the skin cells. Allocates nothing up to max_cells. @pre maximum > 0,
  /// sizes agree.
  void set(const TargetField& target, double maximum);

  PressureSample sample(const Vec2& x) const;

 private:
  /// The 16 values from (first_row, first_col) on, zero beyond the raster.
  void copy_neighbourhood(int first_col, int first_row, std::array<double, 16>& copy) const;

  int rows_ = 0, cols_ = 0;
  double cell_ = 1.0;  // [mm]
  std::vector<double> value_;
};

}  // namespace prostm::planning
