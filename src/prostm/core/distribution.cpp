#include "prostm/core/distribution.hpp"

#include <algorithm>
#include <cmath>

namespace prostm {

Distribution::Distribution(std::size_t capacity) : capacity_(std::max<std::size_t>(capacity, 2)) {
  kept_.reserve(capacity_);
}

void Distribution::add(double value) noexcept {
  // Welford's update: exact enough over millions of values
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
  std::vector<double> sorted = kept_;
  std::sort(sorted.begin(), sorted.end());
  const auto quantile = [&](double q) {
    const auto rank = static_cast<std::size_t>(std::ceil(q * static_cast<double>(sorted.size())));
    return sorted[std::clamp<std::size_t>(rank, 1, sorted.size()) - 1];
  };
  s.n = count_;
  s.mean = mean_;
  s.deviation = std::sqrt(squares_ / static_cast<double>(count_));
  s.p50 = quantile(0.50);
  s.p99 = quantile(0.99);
  s.max = max_;
  return s;
}

}  // namespace prostm
