#pragma once
/// Parallel work on bands of rows of a raster. Private to score.

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "prostm/core/worker_pool.hpp"

namespace prostm {

/// Rows of a band.
inline constexpr std::size_t kBandRows = 16;

/// Calls f(first row, end) for bands of band_rows rows, in parallel on the pool if it is not null.
/// @pre f writes only to data of its own rows.
template <class F>
void for_bands(WorkerPool* pool, std::size_t rows, F&& f, std::size_t band_rows = kBandRows) {
  const auto bands = static_cast<int>((rows + band_rows - 1) / band_rows);
  const auto band = [&](int i) {
    const std::size_t first = static_cast<std::size_t>(i) * band_rows;
    f(first, std::min(first + band_rows, rows));
  };
  if (pool != nullptr) {
    pool->run(bands, band);
  } else {
    for (int i = 0; i < bands; ++i) band(i);
  }
}

/// Sums the arrays that f(first, end) returns for bands of band_rows of n rows, in order, so that
/// the sums do not depend on the number of threads.
template <std::size_t kSums, class F>
std::array<double, kSums> sums_of_bands(WorkerPool* pool, std::size_t n, F&& f,
                                        std::size_t band_rows = kBandRows) {
  std::vector<std::array<double, kSums>> parts((n + band_rows - 1) / band_rows);
  const auto part = [&](std::size_t first, std::size_t end) {
    parts[first / band_rows] = f(first, end);
  };
  for_bands(pool, n, part, band_rows);
  std::array<double, kSums> sums{};
  for (const auto& of_part : parts) {
    for (std::size_t i = 0; i < kSums; ++i) sums[i] += of_part[i];
  }
  return sums;
}

}  // namespace prostm
