#include "prostm/study/extra/practice.hpp"

#include <algorithm>

namespace prostm {

double Practice::share() const {
  const std::size_t n = std::min(right_.size(), window());
  if (n == 0) return 0.0;
  const auto right = std::count(right_.end() - static_cast<std::ptrdiff_t>(n), right_.end(), true);
  return static_cast<double>(right) / static_cast<double>(n);
}

bool Practice::passed() const {
  constexpr double kRounding = 1e-9;
  if (!has_criterion()) return true;
  return right_.size() >= window() && share() >= settings_.right - kRounding;
}

}  // namespace prostm
