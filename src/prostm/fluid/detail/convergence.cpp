#include "prostm/fluid/detail/convergence.hpp"

#include <algorithm>
#include <cmath>

namespace prostm::fluid {
namespace {

/// Calls use(c) for every cell of the rows' spans that has an equation.
template <class Use>
void over_cut_cells(const PressureLevel& level, const Use& use) {
  for (int k = level.box.lower[2]; k < level.box.upper[2]; ++k) {
    for (int j = level.box.lower[1]; j < level.box.upper[1]; ++j) {
      const RowSpan span = level.span(j, k);
      const Index c = level.grid.index(0, j, k);
      for (int i = span.begin; i < std::min<int>(span.end, level.grid.n); ++i) {
        if (level.inverse[c + i] > 0.0F) use(c + i);
      }
    }
  }
}

}  // namespace

Convergence::Convergence(const PaddedGrid& grid) {
  const auto n = static_cast<std::size_t>(grid.n);
  kept_.reserve(n * n * n);
}

void Convergence::begin() {
  iterations_ = 0;
  before_ = last_ = pressure_ = 0.0;
}

void Convergence::keep(const PressureLevel& level, const Field& p) {
  kept_.clear();
  over_cut_cells(level, [&](Index c) { kept_.push_back(p[c]); });
}

void Convergence::compare(const PressureLevel& level, const Field& p) {
  ++iterations_;
  before_ = last_;
  last_ = pressure_ = 0.0;
  std::size_t at = 0;
  over_cut_cells(level, [&](Index c) {
    const auto now = static_cast<double>(p[c]), change = now - static_cast<double>(kept_[at++]);
    last_ += change * change;
    pressure_ += now * now;
  });
}

double Convergence::error() const {
  // ρ of a V-cycle: the first one after a warm start takes more away than those that follow
  constexpr double kLeast = 0.3;
  constexpr double kMost = 0.995;  // of sweeps that hardly converge
  if (!std::isfinite(last_ + before_ + pressure_) || pressure_ == 0.0 || last_ == 0.0) return 0.0;
  double left = kLeast;
  if (iterations_ > 1 && before_ > 0.0)
    left = std::clamp(std::sqrt(last_ / before_), kLeast, kMost);
  return std::sqrt(last_ / pressure_) * left / (1.0 - left);
}

}  // namespace prostm::fluid
