#include "prostm/fluid/detail/pressure/convergence.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace prostm::fluid {
namespace {

/// Calls use(row, cells) for the cells of every row's span; those that have no equation hold 0.
template <class Use>
void over_spans(const PressureLevel& level, const Field& p, const Use& use) {
  for (int k = level.box.lower[2]; k < level.box.upper[2]; ++k) {
    for (int j = level.box.lower[1]; j < level.box.upper[1]; ++j) {
      const RowSpan span = level.span(j, k);
      const int cells = std::min<int>(span.end, level.grid.n) - span.begin;
      if (cells > 0) use(p.data() + level.grid.index(span.begin, j, k), cells);
    }
  }
}

/// A sum in lanes, so that the compiler may use vectors.
struct LaneSum {
  static constexpr int kLanes = 8;
  double of[kLanes] = {};
  double total() const { return std::accumulate(of, of + kLanes, 0.0); }
};

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
  over_spans(level, p,
             [&](const float* row, int cells) { kept_.insert(kept_.end(), row, row + cells); });
}

void Convergence::compare(const PressureLevel& level, const Field& p) {
  LaneSum changes, pressures;
  const float* kept = kept_.data();
  over_spans(level, p, [&](const float* row, int cells) {
    for (int first = 0; first < cells; first += LaneSum::kLanes) {
      const int lanes = std::min(LaneSum::kLanes, cells - first);
      for (int lane = 0; lane < lanes; ++lane) {
        const auto now = static_cast<double>(row[first + lane]);
        const double change = now - static_cast<double>(kept[first + lane]);
        changes.of[lane] += change * change;
        pressures.of[lane] += now * now;
      }
    }
    kept += cells;
  });
  ++iterations_;
  before_ = last_;
  last_ = changes.total();
  pressure_ = pressures.total();
}

double Convergence::error() const {
  // ρ of a V-cycle: the first one after a warm start reduces the error more than those that follow
  constexpr double kLeast = 0.3;
  constexpr double kMost = 0.995;  // of sweeps that hardly converge
  if (!std::isfinite(last_ + before_ + pressure_) || pressure_ == 0.0 || last_ == 0.0) return 0.0;
  double left = kLeast;
  if (iterations_ > 1 && before_ > 0.0)
    left = std::clamp(std::sqrt(last_ / before_), kLeast, kMost);
  return std::sqrt(last_ / pressure_) * left / (1.0 - left);
}

}  // namespace prostm::fluid
