#pragma once
/// The discrete Poisson problem on one grid of the hierarchy: open fractions of faces around the
/// hands, and the diagonal.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "prostm/core/worker_pool.hpp"
#include "prostm/fluid/detail/padded_grid.hpp"
#include "prostm/hand/hand_raster.hpp"

namespace prostm::fluid {

/// Cells [begin, end) of a row, both multiples of 16, that hands touch; elsewhere in the row every
/// face is open.
struct RowSpan {
  std::int16_t begin = 0, end = 0;
  bool empty() const { return begin >= end; }
};

/// Returns the smallest span that contains both.
inline RowSpan join(RowSpan a, RowSpan b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.begin, b.begin), std::max(a.end, b.end)};
}

/// Σ_f a_f (p − p_f) = b over the six faces of a cell, (F5) and (F6) of docs/design/fluid.md: a_f
/// is the open fraction, over the distance in cells from the centre to the box's open side where
/// the face belongs to one, where p_f = 0, and 0 on the floor. The neighbour sum needs no special
/// case there because halos of p stay 0; only the diagonal Σ a_f differs. Far from hands the
/// diagonal takes few values, kept in tables. Face fractions and stored diagonals are read only in
/// the rows' spans, which saves most of the memory traffic.
struct PressureLevel {
  /// @param last_to_side distance from the last cell's centre to the box's side [cells]: more than
  /// half where the cells along an edge of the finest level are no multiple of a cell here.
  explicit PressureLevel(int n, float last_to_side = 0.5F);

  /// Opens every cell: forgets the hands.
  void open_all();
  /// Sets fractions, as means of the four faces of `fine` (Weber et al. 2015), spans and diagonals.
  void coarsen_from(const PressureLevel& fine);
  /// Narrows the spans of plane k to the cells that have a face that is not open.
  void narrow_spans(int k);
  /// Sets the diagonals in the spans of plane k. A cell whose diagonal is below `kClosed` is solid:
  /// no equation, p = 0.
  void fill_diagonal(int k);

  const RowSpan& span(int j, int k) const {
    return spans[static_cast<std::size_t>(k) * static_cast<std::size_t>(grid.n) +
                 static_cast<std::size_t>(j)];
  }
  RowSpan& span(int j, int k) {
    return spans[static_cast<std::size_t>(k) * static_cast<std::size_t>(grid.n) +
                 static_cast<std::size_t>(j)];
  }
  /// The part of row (j, k) of an axis's faces, end included, beyond which all are open; j and k
  /// run to one beyond the box along their own axis.
  RowSpan face_span(int axis, int j, int k) const {
    // a face is in the spans of the cells on both sides; the last one is beyond the box
    return span(j - (axis == 1 && j == box.upper[1]), k - (axis == 2 && k == box.upper[2]));
  }
  /// Tables along x of the diagonal and its inverse (0 beyond n) for an uncut row.
  const float* table_diagonal(int j, int k) const { return diagonal_tables[table(j, k)].data(); }
  const float* table_inverse(int j, int k) const { return inverse_tables[table(j, k)].data(); }
  /// D⁻¹ of a cell, 0 where there is no equation: closed cells and everything outside the grid.
  float inverse_at(int i, int j, int k) const;

  static constexpr float kClosed = 1e-3F;
  static constexpr int kMaxCells = 160;  ///< the largest n: rows fit buffers of this size

  PaddedGrid grid;
  Field open[3];               ///< face fractions 0..1; 1 outside `box`, 0 on the floor
  Field diagonal, inverse;     ///< valid in spans
  std::vector<RowSpan> spans;  ///< n², row j of plane k at k·n + j
  CellBox box;                 ///< cells that may have a face that is not open
  bool always_full = false;    ///< a small level: spans cover every row

 private:
  /// a_f of the faces before and after cell i of an axis, if open.
  float before(int i) const { return i == 0 ? 2.0F : 1.0F; }
  float after(int i) const { return i == grid.n - 1 ? side_weight_ : 1.0F; }
  /// Rows at either side of the box and between them, along y and z.
  std::size_t table(int j, int k) const {
    const auto place = [&](int i) { return i == 0 ? 0 : i == grid.n - 1 ? 2 : 1; };
    return static_cast<std::size_t>(place(j) + 3 * place(k));
  }

  void coarsen_faces(const PressureLevel& fine, int axis);

  float side_weight_;
  std::vector<float> diagonal_tables[9], inverse_tables[9];
};

}  // namespace prostm::fluid
