#include "prostm/core/distribution.hpp"

#include <algorithm>
#include <cmath>

namespace prostm {

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
  const auto at = values.begin() +
                  static_cast<std::ptrdiff_t>(std::clamp<std::size_t>(rank, 1, values.size())) - 1;
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

Distribution::Distribution(std::size_t capacity) : capacity_(std::max<std::size_t>(capacity, 2)) {
  kept_.reserve(capacity_);
}

void Distribution::add(double value) noexcept {
  // Welford's update: accurate over millions of values
  max_ = count_ == 0 ? value : std::max(max_, value);
  const double delta = value - mean_;
  mean_ += delta / static_cast<double>(count_ + 1);
  squares_ += delta * (value - mean_);

  if (count_ % stride_ == 0) {
    if (kept_.size() == capacity_) {
      std::size_t n = 0;
      for (std::size_t i = 0; i < kept_.size(); i += 2) kept_[n++] = kept_[i];
      kept_.resize(n);
      stride_ *= 2;
    }
    if (count_ % stride_ == 0) kept_.push_back(value);
  }
  ++count_;
}

Summary Distribution::summary() const {
  Summary s;
  if (count_ == 0) return s;
  s.n = count_;
  s.mean = mean_;
  s.deviation = std::sqrt(squares_ / static_cast<double>(count_));
  s.p50 = quantile(kept_, 0.50);
  s.p99 = quantile(kept_, 0.99);
  s.max = max_;
  return s;
}

}  // namespace prostm
