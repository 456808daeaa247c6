#pragma once
/// Hands in the fluid: open fractions of faces, closed cells, and the velocity of the walls.

#include <atomic>
#include <cstdint>
#include <vector>

#include "prostm/core/worker_pool.hpp"
#include "prostm/fluid/detail/padded_grid.hpp"
#include "prostm/fluid/detail/pressure/pressure_level.hpp"
#include "prostm/fluid/fluid.hpp"
#include "prostm/hand/hand_raster.hpp"

namespace prostm::fluid {

/// Returns the fraction 0..1 of a square's area where the signed distance is positive, from its
/// corners in order around it (F4): the square is cut into four triangles at its centre (the
/// corners' mean), and each is cut along a straight line.
float open_fraction(float a, float b, float c, float d);

/// Keeps the hands' part of the problem between steps. Faces whose distance at all four nodes is
/// positive are open; a cell with less than `kMinOpening` of open face in all is closed, and so is
/// a pocket that no open face joins to the outside: its equations would have no solution.
class Obstacle {
 public:
  Obstacle(int n, WorkerPool& pool, HandFaces faces = HandFaces::Fractions);

  /// Sets `level`'s fractions, spans and diagonals, and the walls' velocities. @pre the raster is
  /// of this grid and finite.
  void update(const HandRaster& raster, PressureLevel& level);

  /// Velocity of the wall normal to the faces of an axis [m/s], valid where a face is not open.
  const Field& wall_velocity(int axis) const { return wall_[axis]; }
  /// The same for writing, to set the floor's jets once: faces k = 0 of axis 2.
  Field& wall_velocity(int axis) { return wall_[axis]; }

  bool closed(Index c) const { return state_[c] == kClosed; }
  int closed_cells() const { return closed_cells_; }

  static constexpr float kMinOpening = 0.6F;    // sum of a cell's six fractions
  static constexpr float kMinFraction = 0.02F;  // a smaller gap is shut

 private:
  /// A narrow cell has too little open face and is about to be closed.
  enum CellState : std::uint8_t { kReached, kOpen, kNarrow, kClosed };

  void forget();
  void find_inside(const HandRaster& raster, int k);
  RowSpan nodes_inside(int j0, int j1, int k0, int k1) const;
  RowSpan cut_cells(int j, int k) const;
  RowSpan cut_faces(int axis, int j, int k) const;
  RowSpan cells_of(const PressureLevel& level, int j, int k) const;
  /// The nodes of a row from the first one in a hand to the last one.
  RowSpan inside(int j, int k) const { return inside_[node_row(j, k)]; }
  RowSpan& inside(int j, int k) { return inside_[node_row(j, k)]; }
  std::size_t node_row(int j, int k) const {
    return static_cast<std::size_t>(k) * static_cast<std::size_t>(grid_.n + 1) +
           static_cast<std::size_t>(j);
  }
  void cut(const HandRaster& raster, PressureLevel& level, int k);
  void classify(const PressureLevel& level, int k);
  void close(PressureLevel& level, Index c);
  void reach_along_rows(const PressureLevel& level, int k);
  void close_narrow(PressureLevel& level);
  void close_pockets(PressureLevel& level);
  void count_closed(const PressureLevel& level, int k);
  void flood(const PressureLevel& level, Index seed);
  template <class F>
  void for_cells(const PressureLevel& level, CellState state, F&& f);

  PaddedGrid grid_;
  WorkerPool& pool_;
  HandFaces faces_;
  Field wall_[3];
  PaddedField<std::uint8_t> state_;  // kReached outside the box
  std::vector<RowSpan> inside_;      // a row of nodes each, where the box has some
  std::vector<Index> stack_;         // room for all cells
  CellBox box_;
  std::atomic<int> closed_cells_{0};
};

/// Whether a cell's centre is in a hand, by the mean distance of its nodes.
inline bool is_in_hand(const HandRaster& raster, int i, int j, int k) {
  const auto row = static_cast<std::size_t>(raster.grid.nx + 1),
             plane = row * static_cast<std::size_t>(raster.grid.ny + 1);
  const float* d = raster.node_distance.data() + raster.grid.node_index(i, j, k);
  const float eight = ((d[0] + d[1]) + (d[row] + d[row + 1])) +
                      ((d[plane] + d[plane + 1]) + (d[plane + row] + d[plane + row + 1]));
  return eight <= 0.0F;
}

/// Returns the height of the lowest node in a hand above the array [m]; infinite without hands.
double lowest_of(const HandRaster& raster);

/// True if every distance and velocity in the raster's box is a finite number.
bool is_finite(const HandRaster& raster, WorkerPool& pool);

}  // namespace prostm::fluid
