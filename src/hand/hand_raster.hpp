#pragma once
/// Hands on the fluid's grid.

#include <cstdint>
#include <vector>

#include "core/geometry.hpp"
#include "core/worker_pool.hpp"
#include "hand/hand_shape.hpp"
#include "track/hand_frame.hpp"

namespace prostm {

/// Half-open box of cells.
struct CellBox {
  int lower[3] = {0, 0, 0}, upper[3] = {0, 0, 0};
  bool empty() const { return lower[0] >= upper[0] || lower[1] >= upper[1] || lower[2] >= upper[2]; }
};

/// Signed distance at the grid's nodes and skin velocity at its cells, in a narrow band around the hands.
struct HandRaster {
  GridShape grid;
  CellBox box;                            ///< cells that may touch a hand or its band, clipped to the grid
  std::vector<float> node_distance;       ///< node_count() [m]; kFar outside the box
  std::vector<float> velocity[3];         ///< cell_count() each [m/s], of the nearest skin point; 0 outside the box
  std::vector<std::uint8_t> swept;        ///< cell_count(), 1 where the hand passed since the last raster and is gone now
  static constexpr float kFar = 1.0F;     ///< [m]
};

/// Rasterises hands with their motion since the last frame.
class HandRasteriser {
 public:
  /// @param band width of the narrow band in cells, >= 2. @throws std::invalid_argument.
  HandRasteriser(const GridShape& grid, double band = 3.0);

  /// Fills `raster()` with the hands of `frame` (frame D). The motion since the previous call is sub-stepped so that no joint
  /// moves more than one cell between sub-poses (at most 16), and cells that only sub-poses touch are marked
  /// `swept` with the hand's velocity there, so that nothing tunnels. Allocates nothing.
  void rasterise(const HandFrame& frame, WorkerPool& pool) noexcept;

  const HandRaster& raster() const { return raster_; }

 private:
  HandRaster raster_;
  double band_;
  HandFrame previous_;
};

}  // namespace prostm
