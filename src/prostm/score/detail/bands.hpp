#pragma once
/// Work on rasters by bands of rows. Private to score.

#include <algorithm>
#include <cstddef>

#include "prostm/core/worker_pool.hpp"

namespace prostm {

/// Rows of a band.
inline constexpr std::size_t kBandRows = 16;

/// Calls f(first row, end) for bands of kBandRows rows, by the threads of the pool if it is not
/// null. @pre f writes to places that depend on the rows alone.
template <class F>
void for_bands(WorkerPool* pool, std::size_t rows, F&& f) {
  const auto bands = static_cast<int>((rows + kBandRows - 1) / kBandRows);
  const auto band = [&](int i) {
    const std::size_t first = static_cast<std::size_t>(i) * kBandRows;
    f(first, std::min(first + kBandRows, rows));
  };
  if (pool != nullptr) {
    pool->run(bands, band);
  } else {
    for (int i = 0; i < bands; ++i) band(i);
  }
}

}  // namespace prostm
