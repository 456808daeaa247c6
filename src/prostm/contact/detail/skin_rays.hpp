#pragma once
/// Rays to the skin, through the distances at the nodes of a raster. Private to contact.

#include <vector>

#include "prostm/hand/hand_raster.hpp"

namespace prostm {

inline constexpr double kMarchStep = 0.5;  ///< step of a ray through the distances [cells]

/// Returns t of the first crossing from outside to inside along start + t·direction, 0 <= t <=
/// t_max [m]; negative without a crossing, or if the start is inside: such skin does not face the
/// array. The distance is trilinear between nodes and HandRaster::kFar outside the grid. It is
/// sampled every kMarchStep and interpolated linearly. The reference for SkinRays.
/// @param direction unit vector.
double march(const HandRaster& raster, const Vec3& start, const Vec3& direction, double t_max);

/// Finds the same crossings with fewer samples: trilinear values are negative only in cells with a
/// node inside a hand, so below the lowest such node of its column a ray only checks its position.
class SkinRays {
 public:
  explicit SkinRays(const GridShape& grid);

  /// Sets the raster and keeps a reference to it; call again when it changes. Allocates nothing.
  /// @pre raster.grid is the grid of the constructor, except for its corner.
  void set(const HandRaster& raster) noexcept;

  /// Box of all cells that may have a node inside a hand.
  const CellBox& box() const { return box_; }
  /// Returns the crossing of the ray along z through the centre of a column, z [m] in D; NaN
  /// without a crossing. march() finds the same one if it starts below the hand, at the height of a
  /// node.
  double column(int i, int j) const noexcept;
  /// Returns the unit normal of the skin at a crossing, pointing into the hand: the negative
  /// gradient of the distance in the crossing's cell. @pre the crossing is in the grid.
  Vec3 inwards(const Vec3& p_D) const noexcept;
  /// Same as the function march(), up to rounding.
  double march(const Vec3& start, const Vec3& direction, double t_max) const noexcept;

 private:
  std::size_t column_index(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(grid_.nx) +
           static_cast<std::size_t>(i);
  }
  void find_lowest_nodes() noexcept;
  void find_lowest_cells() noexcept;
  bool may_be_inside(const Vec3& q) const noexcept;
  double distance(const Vec3& q) const noexcept;
  double mean_of_level(int i, int j, int k) const noexcept;

  GridShape grid_;
  const HandRaster* raster_ = nullptr;
  CellBox box_;
  Vec3 first_ = Vec3::Zero(), last_ = Vec3::Zero();  // corners of box_ [cells]
  std::vector<int> node_level_;                      // level of the lowest node inside, by column
  std::vector<int> cell_level_;  // level of the lowest cell with such a node, by column
};

}  // namespace prostm
