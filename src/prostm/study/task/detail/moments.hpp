#pragma once
/// Sums over a sample. Private to study.

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <span>
#include <vector>

namespace prostm::study {

inline double sum_of(std::span<const double> x) {
  return std::accumulate(x.begin(), x.end(), 0.0);
}

/// @pre not empty.
inline double mean(std::span<const double> x) {
  return sum_of(x) / static_cast<double>(x.size());
}

/// Σ (x − mean)². @pre not empty.
inline double squares(std::span<const double> x) {
  const double m = mean(x);
  double sum = 0.0;
  for (const double v : x) sum += (v - m) * (v - m);
  return sum;
}

/// Whether values vary by more than rounding. @pre not empty.
inline bool varies(std::span<const double> x) {
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  return *high - *low > 1e-12 * std::max(std::abs(*low), std::abs(*high));
}

/// b − a, pair by pair. @pre a and b have the same size.
inline std::vector<double> differences(std::span<const double> a, std::span<const double> b) {
  std::vector<double> out(a.size());
  std::transform(b.begin(), b.end(), a.begin(), out.begin(), std::minus<>());
  return out;
}

}  // namespace prostm::study
