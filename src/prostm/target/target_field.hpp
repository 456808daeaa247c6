#pragma once
/// The target: the pressure on the skin to be rendered, projected on a plane and sampled on a
/// raster.

#include <boost/container/static_vector.hpp>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "prostm/core/geometry.hpp"

namespace prostm {

/// Maximum number of cells of a raster that can be read or planned: 10⁶, or 5 m × 5 m at 5 mm.
inline constexpr std::size_t kMaxFieldCells = 1'000'000;

/// The target pressure field T = {(x_i, p*(x_i))} of the paper's section IV-A on a regular raster
/// of the plane P.
///
/// Row-major: the centre of cell (row, col) lies at origin + cell·(col, row) in P. `pressure` is
/// any non-negative quantity (a plan scales with it); `height` is the skin's distance from the
/// plane along its normal, positive away from the array, so that a point x of the plane is lifted
/// to X_DP · (x, height); `weight` is the weight of a cell's error when a plan is fitted to the
/// field (presets `best`, `fast` and `felt`); only the ratios of the weights have an effect.
struct TargetField {
  int rows = 0, cols = 0;
  double cell = 0.0;               ///< edge of a cell [m]
  Vec2 origin = Vec2::Zero();      ///< centre of cell (0, 0) in P [m]
  std::vector<double> pressure;    ///< rows·cols, >= 0, 0 where there is no skin
  std::vector<std::uint8_t> skin;  ///< rows·cols, 1 where there is skin
  std::vector<double> height;      ///< rows·cols [m], finite everywhere (see fill_heights)
  std::vector<double> weight;      ///< empty: 1 everywhere; else rows·cols, >= 0, dimensionless
  /// Signed parts of the air's pressure: that of the blowing smoke, and that of the hand's own
  /// movement. The pressure is one of them or their sum, clamped at 0. Both are empty if the parts
  /// are not known separately; else rows·cols, 0 where there is no skin.
  std::vector<double> smoke, movement;
  Pose X_DP = default_plane();  ///< the plane in frame D: normal is P's z axis

  std::size_t size() const { return pressure.size(); }
  std::size_t index(int row, int col) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(cols) +
           static_cast<std::size_t>(col);
  }
  Vec2 position(int row, int col) const { return origin + cell * Vec2(col, row); }
  /// Position of a cell by its index. @pre index < size().
  Vec2 position(std::size_t index) const {
    const auto width = static_cast<std::size_t>(cols);
    return position(static_cast<int>(index / width), static_cast<int>(index % width));
  }

  /// Sets the shape, resets every cell to no skin, pressure 0 and height 0, and removes weights and
  /// parts. Allocates only when the raster grows.
  void resize(int new_rows, int new_cols);

  /// The plane parallel to the array, 200 mm above its centre.
  static Pose default_plane();
};

/// Checks a field.
/// @throws std::invalid_argument with a message that names the value and the bound, for sizes that
/// disagree, an empty or too large raster, a cell size that is not positive and finite, a pressure
/// that is negative or not finite, pressure where there is no skin, a height or plane that is not
/// finite, a plane whose axes are not orthonormal, a weight that is negative or not finite, weights
/// that are 0 on all skin, a part that is not finite.
void validate(const TargetField& field);

/// Largest pressure; 0 for a field without skin.
double max_pressure(const TargetField& field);

/// Sum of the pressures on skin.
double total_pressure(const TargetField& field);

/// Largest weight on skin; 0 for a field without skin. @pre the field has weights.
double max_weight(const TargetField& field);

/// Extends the heights of the skin to the cells without skin: each gets the height of the nearest
/// skin cell, by breadth-first search, so that a path that bridges a gap between fingers stays near
/// the skin. All heights become 0 if there is no skin.
void fill_heights(TargetField& field);
/// Same, for repeated calls. @param queue scratch memory to keep between calls; nothing is
/// allocated if its capacity is at least rows·cols.
void fill_heights(TargetField& field, std::vector<std::uint32_t>& queue);

/// Height at a point of the plane [m]: bilinear between cell centres, clamped to the raster's
/// border.
double height_at(const TargetField& field, const Vec2& x);

/// One frame of targets: a patch per hand, each with its own plane.
inline constexpr int kMaxPatches = 2;
struct TargetFrame {
  double time = 0.0;  ///< time of the hand frame from which it was computed [s]
  boost::container::static_vector<TargetField, kMaxPatches> patches;
};

}  // namespace prostm
