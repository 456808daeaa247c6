#pragma once
/// Mean, spread and quantiles of a series of measurements, with storage sized once.

#include <cstddef>
#include <vector>

namespace prostm {

/// Returns the smallest value that a share `share` of the values does not exceed (nearest-rank
/// rule); 0 if empty.
double quantile(std::vector<double> values, double share);

struct Summary {
  std::size_t n = 0;
  double mean = 0.0, deviation = 0.0;      ///< standard deviation of the population
  double p50 = 0.0, p99 = 0.0, max = 0.0;  ///< quantiles by the nearest-rank rule
};

/// Collects values; add() never allocates. When the storage is full, every second kept value is
/// dropped, and from then on only every second new value is kept (and so on). Quantiles are then
/// those of a sample evenly spaced in time; n, mean, deviation and max stay exact.
class Distribution {
 public:
  explicit Distribution(std::size_t capacity = 1 << 16);
  void add(double value) noexcept;
  Summary summary() const;  ///< all zeros when empty
  std::size_t count() const { return count_; }

 private:
  std::vector<double> kept_;
  std::size_t capacity_, stride_ = 1, count_ = 0;
  double mean_ = 0.0, squares_ = 0.0, max_ = 0.0;
};

}  // namespace prostm
