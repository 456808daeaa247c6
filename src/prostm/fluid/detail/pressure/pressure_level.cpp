#include "prostm/fluid/detail/pressure/pressure_level.hpp"

#include <algorithm>

namespace prostm::fluid {
namespace {

constexpr int kSmallLevel = 9;  // below this, tables are not worth their branches

}  // namespace

PressureLevel::PressureLevel(int n, float last_to_side)
    : grid{n},
      open{Field(grid, 1.0F), Field(grid, 1.0F), Field(grid, 1.0F)},
      diagonal(grid),
      inverse(grid),
      spans(static_cast<std::size_t>(n) * static_cast<std::size_t>(n)),
      always_full(n <= kSmallLevel),
      side_weight_(1.0F / last_to_side) {
  for (int j = 0; j < n; ++j) std::fill_n(open[2].data() + grid.index(0, j, 0), n, 0.0F);
  for (const int k : {0, 1, n - 1}) {
    for (const int j : {0, 1, n - 1}) {
      auto& d = diagonal_tables[table(j, k)];
      auto& inv = inverse_tables[table(j, k)];
      d.assign(static_cast<std::size_t>(grid.width()), 0.0F);
      inv = d;
      const float across = before(j) + after(j) + (k == 0 ? 0.0F : 1.0F) + after(k);
      for (int i = 0; i < n; ++i) {
        const auto at = static_cast<std::size_t>(i);
        d[at] = before(i) + after(i) + across;
        inv[at] = 1.0F / d[at];
      }
    }
  }
  open_all();
}

void PressureLevel::open_all() {
  for (int axis = 0; axis < 3 && !box.empty(); ++axis) {
    for (int k = box.lower[2]; k < box.upper[2] + (axis == 2); ++k) {
      for (int j = box.lower[1]; j < box.upper[1] + (axis == 1); ++j) {
        const RowSpan cut = face_span(axis, j, k);
        if (cut.empty()) continue;
        float* row = open[axis].data() + grid.index(0, j, k);
        std::fill(row + cut.begin, row + cut.end + 1, axis == 2 && k == 0 ? 0.0F : 1.0F);
      }
    }
  }
  box = CellBox{};
  const auto full = static_cast<std::int16_t>(always_full ? grid.width() : 0);
  std::fill(spans.begin(), spans.end(), RowSpan{0, full});
  if (always_full) {
    for (int k = 0; k < grid.n; ++k) fill_diagonal(k);
  }
}

void PressureLevel::coarsen_from(const PressureLevel& fine) {
  open_all();
  if (fine.box.empty()) return;
  for (int a = 0; a < 3; ++a) {
    box.lower[a] = fine.box.lower[a] / 2;
    box.upper[a] = std::min((fine.box.upper[a] + 1) / 2, grid.n);
  }
  for (int k = box.lower[2]; k < box.upper[2] && !always_full; ++k) {
    for (int j = box.lower[1]; j < box.upper[1]; ++j) {
      const RowSpan four = join(join(fine.span(2 * j, 2 * k), fine.span(2 * j + 1, 2 * k)),
                                join(fine.span(2 * j, 2 * k + 1), fine.span(2 * j + 1, 2 * k + 1)));
      span(j, k) = {static_cast<std::int16_t>(four.begin / 2),
                    static_cast<std::int16_t>((four.end + 1) / 2)};
    }
  }
  for (int axis = 0; axis < 3; ++axis) coarsen_faces(fine, axis);
  for (int k = always_full ? 0 : box.lower[2]; k < (always_full ? grid.n : box.upper[2]); ++k) {
    narrow_spans(k);
    fill_diagonal(k);
  }
}

void PressureLevel::coarsen_faces(const PressureLevel& fine, int axis) {
  const Index s = fine.grid.stride((axis + 1) % 3), t = fine.grid.stride((axis + 2) % 3);
  for (int k = box.lower[2]; k < box.upper[2] + (axis == 2); ++k) {
    for (int j = box.lower[1]; j < box.upper[1] + (axis == 1); ++j) {
      const RowSpan cut = face_span(axis, j, k);
      if (cut.empty()) continue;
      float* to = open[axis].data() + grid.index(0, j, k);
      const float* from = fine.open[axis].data() + fine.grid.index(0, 2 * j, 2 * k);
      const int end = std::min<int>(cut.end, box.upper[0]) + (axis == 0);
      for (int i = std::max<int>(cut.begin, box.lower[0]); i < end; ++i) {
        const float* f = from + 2 * i;
        to[i] = 0.25F * ((f[0] + f[s]) + (f[t] + f[s + t]));
      }
    }
  }
}

void PressureLevel::narrow_spans(int k) {
  if (always_full) return;
  const Index row = grid.row(), plane = grid.plane();
  const float lowest = k == 0 ? 0.0F : 1.0F;  // the floor is shut
  for (int j = box.lower[1]; j < box.upper[1]; ++j) {
    const Index c = grid.index(0, j, k);
    const float *x = open[0].data() + c, *y = open[1].data() + c, *z = open[2].data() + c;
    RowSpan& cut = span(j, k);
    int first = grid.n, last = -1;
    const int begin = std::max<int>(cut.begin, box.lower[0]),
              end = std::min<int>(cut.end, box.upper[0]);
    for (int i = begin; i < end; ++i) {
      const bool is_open = x[i] == 1.0F && x[i + 1] == 1.0F && y[i] == 1.0F && y[i + row] == 1.0F &&
                           z[i] == lowest && z[i + plane] == 1.0F;
      if (is_open) continue;
      first = std::min(first, i);
      last = i;
    }
    const auto lane = static_cast<int>(PaddedGrid::kLane);
    cut = last < 0 ? RowSpan{}
                   : RowSpan{static_cast<std::int16_t>(first / lane * lane),
                             static_cast<std::int16_t>((last / lane + 1) * lane)};
  }
}

void PressureLevel::fill_diagonal(int k) {
  const int n = grid.n;
  const Index row = grid.row(), plane = grid.plane();
  for (int j = 0; j < n; ++j) {
    const RowSpan s = span(j, k);
    const Index c = grid.index(0, j, k);
    const float *x = open[0].data() + c, *y = open[1].data() + c, *z = open[2].data() + c;
    for (int i = s.begin; i < s.end; ++i) {
      float sum = 0.0F;
      if (i < n) {
        sum = x[i] * before(i) + x[i + 1] * after(i) + y[i] * before(j) + y[i + row] * after(j) +
              z[i] + z[i + plane] * after(k);
      }
      const bool solid = sum < kClosed;
      diagonal[c + i] = solid ? 0.0F : sum;
      inverse[c + i] = solid ? 0.0F : 1.0F / sum;
    }
  }
}

float PressureLevel::inverse_at(int i, int j, int k) const {
  const int n = grid.n;
  if (i < 0 || j < 0 || k < 0 || i >= n || j >= n || k >= n) return 0.0F;
  const RowSpan s = span(j, k);
  return i >= s.begin && i < s.end ? inverse[grid.index(i, j, k)] : table_inverse(j, k)[i];
}

}  // namespace prostm::fluid
