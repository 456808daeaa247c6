#pragma once
/// Hands on the fluid's grid.

#include <cstdint>
#include <vector>

#include "prostm/core/geometry.hpp"
#include "prostm/core/worker_pool.hpp"
#include "prostm/hand/detail/body_set.hpp"
#include "prostm/hand/hand_shape.hpp"
#include "prostm/track/hand_frame.hpp"

namespace prostm {

/// Half-open box of cells.
struct CellBox {
  int lower[3] = {0, 0, 0}, upper[3] = {0, 0, 0};
  bool empty() const {
    return lower[0] >= upper[0] || lower[1] >= upper[1] || lower[2] >= upper[2];
  }
};

/// Signed distance at the grid's nodes and skin velocity at its cells, in a narrow band around the
/// hands.
struct HandRaster {
  GridShape grid;
  CellBox box;  ///< cells that may touch a hand, its band or its sweep, clipped to the grid
  /// node_count() values [m]: correct up to the band's width, at least that width beyond it, and
  /// kFar outside the box
  std::vector<float> node_distance;
  /// velocity of the nearest skin point, cell_count() values each [m/s]; 0 more than two cells from
  /// the skin
  std::vector<float> velocity[3];
  /// cell_count() values; 1 where the hand passed since the last raster and is gone now
  std::vector<std::uint8_t> swept;
  static constexpr float kFar = 1.0F;  ///< [m]
};

/// Rasterises hands with their motion since the last frame. Each body of a hand is evaluated only
/// where it can be the nearest. Blocks of the grid are distributed over a pool; the result does not
/// depend on the number of threads.
class HandRasteriser {
 public:
  /// @param band width of the narrow band in cells, 2 to 16. @throws std::invalid_argument, also
  /// for an empty grid.
  HandRasteriser(const GridShape& grid, double band = 3.0);

  /// Moves the grid to another corner [m]; hands are on it from the next rasterise() on.
  void move_to(const Vec3& p_DF) noexcept;

  /// Fills `raster()` with the hands of `frame` (frame D). The motion since the previous call is
  /// sub-stepped so that no joint moves more than one cell between sub-poses (at most 16), and
  /// cells whose centre only sub-poses touch are marked `swept` with the hand's velocity there, so
  /// that nothing tunnels. A hand that was not in the previous frame (by id and side) sweeps
  /// nothing; a hand with a joint that is not finite, or farther than a kilometre from D's origin,
  /// is left out. Allocates nothing.
  void rasterise(const HandFrame& frame, WorkerPool& pool) noexcept;

  const HandRaster& raster() const { return raster_; }

 private:
  /// A pose that a hand went through since the last frame.
  struct SubPose {
    HandShape shape;
    BodySet bodies;
    CellBox cells;        ///< cells whose centres it may touch
    double margin = 0.0;  ///< touched centres are at most this far from the skin [m]
  };

  void set_shapes(const HandFrame& frame) noexcept;
  void add_sub_poses(const Hand& from, const Hand& to) noexcept;
  CellBox range_of(const HandShape& shape, double margin, double offset) const noexcept;
  void place_box() noexcept;
  void fill_nodes(const CellBox& old, const CellBox& root) noexcept;
  void fill_cells(const CellBox& old, const CellBox& root) noexcept;
  void set_cells(const CellBox& root) noexcept;
  void sweep(const SubPose& pose, const CellBox& root) noexcept;

  HandRaster raster_;
  double band_;  // [cells]
  Vec3 middle_;  // centre of the grid, the origin of single-precision positions
  HandFrame previous_;
  boost::container::static_vector<HandShape, BodySet::kMaxHands> shapes_;
  BodySet bodies_;                    // bodies of the shapes
  std::vector<CellBox> node_ranges_;  // nodes of each shape with its band
  std::vector<SubPose> sub_poses_;    // newest first, hand by hand
  std::size_t sub_pose_count_ = 0;    // sub-poses in use
  std::vector<std::uint8_t> solid_;   // per cell: 1 where a hand covers its centre
};

}  // namespace prostm
