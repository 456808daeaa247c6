#pragma once
/// Semi-Lagrangian advection: one backtrace per cell, shared by all fields; scalar and vector
/// kernels.

#include <vector>

#include "prostm/fluid/detail/padded_grid.hpp"

namespace prostm::fluid {

/// Extent of a field in the indices of its own array: `count` values per axis, and the range to
/// which a backtraced position is clamped.
struct Placement {
  int axis = -1;  ///< axis of the face-centred component; −1 for cell centres
  int count[3] = {0, 0, 0};
  float lower[3] = {0, 0, 0}, upper[3] = {0, 0, 0};
};

Placement face_placement(int n, int axis);
/// Placement of cell-centred fields whose halo holds the values outside: smoke.
Placement centre_placement(int n);

/// Least and greatest −d of some cells, per axis; a fourth value makes each a whole vector.
struct ShiftRange {
  alignas(16) float low[4] = {0, 0, 0, 0};
  alignas(16) float high[4] = {0, 0, 0, 0};
};

/// Rows of a block: fewer make more blocks, more make larger boxes of shifted rows.
inline constexpr int kBlockRows = 4;

/// Displacements d of the particles that arrive at the cells, and their ranges in blocks of
/// kBlockRows rows of one vector, which only the vector kernels write and read.
struct Displacements {
  explicit Displacements(const PaddedGrid& grid);
  Field at[3];
  std::vector<ShiftRange> ranges;
};

/// Velocities and displacements here are in cells per step; planes [k0, k1) are written.
struct AdvectionKernels {
  /// Computes the displacement of the particle that arrives at each cell centre, by the midpoint
  /// rule (F2): the velocity half a step back along the cell's own, trilinear between the
  /// cell-centred velocities. Fills the halo of its own rows in x and y.
  void (*trace)(const PaddedGrid& grid, const float* const velocity[3], Displacements& moved,
                int k0, int k1);
  /// out(x) = in(x − d), trilinear (F3); d at a face is the mean of the two cells beside it.
  void (*sample)(const PaddedGrid& grid, const Placement& place, const Displacements& moved,
                 const float* in, float* out, int k0, int k1);
};

const AdvectionKernels& scalar_advection_kernels();
/// Returns the vector kernels for this processor, or the scalar ones if Highway has only its
/// one-lane fallback.
const AdvectionKernels& fast_advection_kernels();

/// Returns the trilinear value at (x, y, z), in the indices of the array. @pre lower ≤ position ≤
/// upper of the field's placement.
float trilinear(const PaddedGrid& grid, const float* field, float x, float y, float z);

/// Copies the first and last value of each row, and the first and last row of planes [k0, k1), into
/// the halo.
void extend_plane(const PaddedGrid& grid, float* field, int k0, int k1);

}  // namespace prostm::fluid
