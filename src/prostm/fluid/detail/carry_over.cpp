#include "prostm/fluid/detail/carry_over.hpp"

#include <algorithm>

namespace prostm::fluid {
namespace {

/// The same along one row of `count` values; `to` may be the row `from`.
void carry_row(const float* from, int by, int count, float* to) {
  const float first = from[0], last = from[count - 1];
  const int begin = std::clamp(-by, 0, count), end = std::clamp(count - by, 0, count);
  if (by >= 0) {
    std::copy(from + std::min(by, count), from + count, to);
  } else {
    std::copy_backward(from, from + end + by, to + end);
  }
  std::fill(to, to + begin, first);
  std::fill(to + end, to + count, last);
}

}  // namespace

void carry_over(const PaddedGrid& grid, const CellShift& by, int axis, Field& field) {
  const int rows = grid.n + (axis == 1 ? 1 : 0), planes = grid.n + (axis == 2 ? 1 : 0);
  const int values = grid.n + (axis == 0 ? 1 : 0);
  // in an order in which no row is read after it was written
  for (int z = 0; z < planes; ++z) {
    const int k = by[2] >= 0 ? z : planes - 1 - z, from_k = std::clamp(k + by[2], 0, planes - 1);
    for (int y = 0; y < rows; ++y) {
      const int j = by[1] >= 0 ? y : rows - 1 - y, from_j = std::clamp(j + by[1], 0, rows - 1);
      carry_row(field.data() + grid.index(0, from_j, from_k), by[0], values,
                field.data() + grid.index(0, j, k));
    }
  }
}

}  // namespace prostm::fluid
