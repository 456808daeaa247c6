#include "prostm/fluid/detail/obstacle.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "prostm/fluid/detail/bytes.hpp"
#include "prostm/fluid/detail/largest.hpp"

namespace prostm::fluid {
namespace {

/// 0 for a face beside a cell in a hand, else 1.
float open_between_voxels(const HandRaster& raster, int axis, int i, int j, int k) {
  const int above[3] = {i, j, k}, n[3] = {raster.grid.nx, raster.grid.ny, raster.grid.nz};
  int below[3] = {i, j, k};
  --below[axis];
  const bool is_in = (above[axis] < n[axis] && is_in_hand(raster, i, j, k)) ||
                     (below[axis] >= 0 && is_in_hand(raster, below[0], below[1], below[2]));
  return is_in ? 0.0F : 1.0F;
}

/// Fraction of a triangle where a linear function with these corner values is positive.
float open_fraction(float a, float b, float c) {
  const int positive = (a > 0.0F) + (b > 0.0F) + (c > 0.0F);
  if (positive == 3) return 1.0F;
  if (positive == 0) return 0.0F;
  // the corner whose sign differs comes first: its small triangle has the area a²/((a − b)(a −
  // c))
  const bool lone_positive = positive == 1;
  if ((b > 0.0F) == lone_positive) {
    std::swap(a, b);
  } else if ((c > 0.0F) == lone_positive) {
    std::swap(a, c);
  }
  const float lone = (a / (a - b)) * (a / (a - c));
  return lone_positive ? lone : 1.0F - lone;
}

}  // namespace

float open_fraction(float a, float b, float c, float d) {
  const int positive = (a > 0.0F) + (b > 0.0F) + (c > 0.0F) + (d > 0.0F);
  if (positive == 4) return 1.0F;
  if (positive == 0) return 0.0F;
  const float centre = 0.25F * ((a + b) + (c + d));
  const float fraction = 0.25F * ((open_fraction(a, b, centre) + open_fraction(b, c, centre)) +
                                  (open_fraction(c, d, centre) + open_fraction(d, a, centre)));
  return fraction < Obstacle::kMinFraction ? 0.0F : fraction;
}

bool is_finite(const HandRaster& raster, WorkerPool& pool) {
  const GridShape& g = raster.grid;
  const CellBox& box = raster.box;
  if (box.empty()) return true;
  const int cells = box.upper[0] - box.lower[0];
  std::atomic<bool> finite{true};
  const auto look = [&](const float* row, int count) {
    if (largest_bits(row, row + count) > kLargestFinite) finite = false;
  };
  pool.run(box.upper[2] - box.lower[2] + 1, [&](int task) {
    const int k = box.lower[2] + task;
    for (int j = box.lower[1]; j <= box.upper[1]; ++j) {
      look(raster.node_distance.data() + g.node_index(box.lower[0], j, k), cells + 1);
      if (j == box.upper[1] || k == box.upper[2]) continue;
      for (const auto& v : raster.velocity)
        look(v.data() + g.cell_index(box.lower[0], j, k), cells);
    }
  });
  return finite;
}

Obstacle::Obstacle(int n, WorkerPool& pool, HandFaces faces)
    : grid_{n},
      pool_(pool),
      faces_(faces),
      wall_{Field(grid_), Field(grid_), Field(grid_)},
      state_(grid_, kReached),
      inside_(static_cast<std::size_t>(n + 1) * static_cast<std::size_t>(n + 1)),
      stack_(static_cast<std::size_t>(n) * static_cast<std::size_t>(n) *
             static_cast<std::size_t>(n)) {}

void Obstacle::forget() {
  for (int k = box_.lower[2]; k < box_.upper[2]; ++k) {
    for (int j = box_.lower[1]; j < box_.upper[1]; ++j) {
      const Index row = grid_.index(0, j, k);
      std::fill(state_.data() + row + box_.lower[0], state_.data() + row + box_.upper[0], kReached);
    }
  }
}

void Obstacle::update(const HandRaster& raster, PressureLevel& level) {
  forget();
  level.open_all();
  closed_cells_ = 0;
  box_ = raster.box;
  if (box_.empty()) return;
  level.box = box_;
  const int planes = box_.upper[2] - box_.lower[2];
  pool_.run(planes + 1, [&](int task) { find_inside(raster, box_.lower[2] + task); });
  pool_.run(planes + 1, [&](int task) { cut(raster, level, box_.lower[2] + task); });
  pool_.run(planes, [&](int task) {
    const int k = box_.lower[2] + task;
    for (int j = box_.lower[1]; j < box_.upper[1]; ++j) level.span(j, k) = cut_cells(j, k);
    level.narrow_spans(k);
    classify(level, k);
  });
  close_narrow(level);
  close_pockets(level);
  pool_.run(planes, [&](int task) {
    level.fill_diagonal(box_.lower[2] + task);
    count_closed(level, box_.lower[2] + task);
  });
}

void Obstacle::find_inside(const HandRaster& raster, int k) {
  for (int j = box_.lower[1]; j <= box_.upper[1]; ++j) {
    const float* row = raster.node_distance.data() + raster.grid.node_index(0, j, k);
    int first = box_.lower[0], last = box_.upper[0];
    while (first <= last && row[first] > 0.0F) ++first;
    while (last > first && row[last] > 0.0F) --last;
    inside(j, k) = {static_cast<std::int16_t>(first), static_cast<std::int16_t>(last + 1)};
  }
}

/// From the first node in a hand to the last one, along x, of four rows.
RowSpan Obstacle::nodes_inside(int j0, int j1, int k0, int k1) const {
  return join(join(inside(j0, k0), inside(j1, k0)), join(inside(j0, k1), inside(j1, k1)));
}

/// The cells of row (j, k) of which a hand may shut a face.
RowSpan Obstacle::cut_cells(int j, int k) const {
  const auto lower = static_cast<std::int16_t>(box_.lower[0]),
             upper = static_cast<std::int16_t>(box_.upper[0]);
  if (faces_ == HandFaces::Voxels) return {lower, upper};
  const RowSpan nodes = nodes_inside(j, j + 1, k, k + 1);
  if (nodes.empty()) return nodes;
  return {std::max<std::int16_t>(nodes.begin - 1, lower), std::min(nodes.end, upper)};
}

/// The faces of an axis in row (j, k) that a hand may shut.
RowSpan Obstacle::cut_faces(int axis, int j, int k) const {
  const auto lower = static_cast<std::int16_t>(box_.lower[0]),
             upper = static_cast<std::int16_t>(box_.upper[0] + (axis == 0));
  if (faces_ == HandFaces::Voxels) return {lower, upper};
  RowSpan span = nodes_inside(j, j + (axis != 1), k, k + (axis != 2));
  // faces of the other axes reach from node to node along x
  if (axis != 0 && !span.empty()) span.begin = std::max<std::int16_t>(span.begin - 1, lower);
  span.end = std::min(span.end, upper);
  return span;
}

void Obstacle::cut(const HandRaster& raster, PressureLevel& level, int k) {
  const GridShape& g = raster.grid;
  const auto row = static_cast<Index>(g.nx + 1), plane = row * (g.ny + 1);
  const Index node_stride[3] = {1, row, plane};
  const Index cell_stride[3] = {1, g.nx, static_cast<Index>(g.nx) * g.ny};
  const int n = grid_.n;
  for (int axis = 0; axis < 3; ++axis) {
    if (k == box_.upper[2] && axis != 2) continue;
    if (k == 0 && axis == 2) continue;  // the floor
    const Index s = node_stride[(axis + 1) % 3], t = node_stride[(axis + 2) % 3];
    for (int j = box_.lower[1]; j < box_.upper[1] + (axis == 1); ++j) {
      float* open = level.open[axis].data() + grid_.index(0, j, k);
      float* wall = wall_[axis].data() + grid_.index(0, j, k);
      const float* phi = raster.node_distance.data() + g.node_index(0, j, k);
      const RowSpan span = cut_faces(axis, j, k);
      for (int i = span.begin; i < span.end; ++i) {
        const bool is_out =
            phi[i] > 0.0F && phi[i + s] > 0.0F && phi[i + s + t] > 0.0F && phi[i + t] > 0.0F;
        if (is_out && faces_ == HandFaces::Fractions) continue;
        open[i] = faces_ == HandFaces::Voxels
                      ? open_between_voxels(raster, axis, i, j, k)
                      : open_fraction(phi[i], phi[i + s], phi[i + s + t], phi[i + t]);
        if (open[i] == 1.0F) continue;
        // the wall moves with the mean of the two cells beside it, or with the one inside the grid
        const int position = axis == 0 ? i : axis == 1 ? j : k;
        const float* v =
            raster.velocity[axis].data() + (static_cast<Index>(k) * g.ny + j) * g.nx + i;
        const float above = position < n ? v[0] : v[-cell_stride[axis]];
        const float below = position > 0 ? v[-cell_stride[axis]] : above;
        wall[i] = 0.5F * (below + above);
      }
    }
  }
}

void Obstacle::classify(const PressureLevel& level, int k) {
  const Index row = grid_.row(), plane = grid_.plane();
  for (int j = box_.lower[1]; j < box_.upper[1]; ++j) {
    // cells outside the span extend to the box's sides, which are connected to the outside
    const RowSpan span = cells_of(level, j, k);
    for (int i = span.begin; i < span.end; ++i) {
      const Index c = grid_.index(i, j, k);
      const Field* a = level.open;
      const float sum = a[0][c] + a[0][c + 1] + a[1][c] + a[1][c + row] + a[2][c] + a[2][c + plane];
      state_[c] = sum == 0.0F ? kClosed : sum < kMinOpening ? kNarrow : kOpen;
    }
  }
}

/// The cells of the box in the span of row (j, k).
RowSpan Obstacle::cells_of(const PressureLevel& level, int j, int k) const {
  const RowSpan span = level.span(j, k);
  return {std::max(span.begin, static_cast<std::int16_t>(box_.lower[0])),
          std::min(span.end, static_cast<std::int16_t>(box_.upper[0]))};
}

/// Calls f(c) for the cells that are in a state when they are visited.
template <class F>
void Obstacle::for_cells(const PressureLevel& level, CellState state, F&& f) {
  for (int k = box_.lower[2]; k < box_.upper[2]; ++k) {
    for (int j = box_.lower[1]; j < box_.upper[1]; ++j) {
      const RowSpan span = cells_of(level, j, k);
      const Index row = grid_.index(0, j, k);
      for_bytes(state_.data() + row, span.begin, span.end, state, [&](int i) { f(row + i); });
    }
  }
}

void Obstacle::count_closed(const PressureLevel& level, int k) {
  std::ptrdiff_t closed = 0;
  for (int j = box_.lower[1]; j < box_.upper[1]; ++j) {
    const RowSpan span = cells_of(level, j, k);
    const std::uint8_t* const row = state_.data() + grid_.index(0, j, k);
    if (!span.empty()) closed += std::count(row + span.begin, row + span.end, kClosed);
  }
  closed_cells_ += static_cast<int>(closed);
}

void Obstacle::close(PressureLevel& level, Index c) {
  for (int axis = 0; axis < 3; ++axis) {
    level.open[axis][c] = 0.0F;
    level.open[axis][c + grid_.stride(axis)] = 0.0F;
  }
  state_[c] = kClosed;
}

void Obstacle::close_narrow(PressureLevel& level) {
  const Index row = grid_.row(), plane = grid_.plane();
  const auto opening = [&](Index c) {
    const Field* a = level.open;
    return a[0][c] + a[0][c + 1] + a[1][c] + a[1][c + row] + a[2][c] + a[2][c + plane];
  };
  std::size_t top = 0;
  for_cells(level, kNarrow, [&](Index c) {
    close(level, c);
    stack_[top++] = c;
  });
  // closing a cell shuts faces of its neighbours, which may become too narrow in turn
  while (top > 0) {
    const Index c = stack_[--top];
    for (const Index o : {Index{-1}, Index{1}, -row, row, -plane, plane}) {
      if (state_[c + o] != kOpen || opening(c + o) >= kMinOpening) continue;
      close(level, c + o);
      stack_[top++] = c + o;
    }
  }
}

void Obstacle::flood(const PressureLevel& level, Index seed) {
  std::size_t top = 0;
  const auto reach = [&](Index c) {
    if (state_[c] != kOpen) return;
    state_[c] = kReached;
    stack_[top++] = c;
  };
  reach(seed);
  while (top > 0) {
    const Index c = stack_[--top];
    for (int axis = 0; axis < 3; ++axis) {
      const Index s = grid_.stride(axis);
      if (level.open[axis][c] > 0.0F) reach(c - s);
      if (level.open[axis][c + s] > 0.0F) reach(c + s);
    }
  }
}

/// Marks most cells of plane k as reached from both ends of their rows, which leaves little to
/// flood.
void Obstacle::reach_along_rows(const PressureLevel& level, int k) {
  for (int j = box_.lower[1]; j < box_.upper[1]; ++j) {
    const RowSpan span = cells_of(level, j, k);
    const Index row = grid_.index(0, j, k);
    const float* open = level.open[0].data() + row;
    std::uint8_t* state = state_.data() + row;
    for (int i = span.begin; i < span.end; ++i) {
      if (state[i] == kOpen && state[i - 1] == kReached && open[i] > 0.0F) state[i] = kReached;
    }
    for (int i = span.end - 1; i >= span.begin; --i) {
      if (state[i] == kOpen && state[i + 1] == kReached && open[i + 1] > 0.0F) state[i] = kReached;
    }
  }
}

void Obstacle::close_pockets(PressureLevel& level) {
  // everything outside the box counts as reached, the halo beyond the open sides too; the floor's
  // faces are shut
  const int planes = box_.upper[2] - box_.lower[2];
  pool_.run(planes, [&](int task) { reach_along_rows(level, box_.lower[2] + task); });
  for_cells(level, kOpen, [&](Index c) {
    bool touches = false;
    for (int axis = 0; axis < 3; ++axis) {
      const Index s = grid_.stride(axis);
      touches = touches || (level.open[axis][c] > 0.0F && state_[c - s] == kReached) ||
                (level.open[axis][c + s] > 0.0F && state_[c + s] == kReached);
    }
    if (touches) flood(level, c);
  });
  for_cells(level, kOpen, [&](Index c) { close(level, c); });
}

double lowest_of(const HandRaster& raster) {
  const CellBox& box = raster.box;
  for (int k = box.lower[2]; k <= box.upper[2] && !box.empty(); ++k) {
    for (int j = box.lower[1]; j <= box.upper[1]; ++j) {
      const float* row = raster.node_distance.data() + raster.grid.node_index(0, j, k);
      if (std::any_of(row + box.lower[0], row + box.upper[0] + 1, [](float d) { return d < 0.0F; }))
        return raster.grid.node(0, 0, k).z();
    }
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace prostm::fluid
