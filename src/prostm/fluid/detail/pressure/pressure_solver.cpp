#include "prostm/fluid/detail/pressure/pressure_solver.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "prostm/fluid/detail/over_planes.hpp"

namespace prostm::fluid {
namespace {

// Relaxation factors of m Jacobi sweeps whose product is the Chebyshev polynomial on [0.25, 1.95],
// the upper part of the spectrum of D⁻¹A: 1/ω = 1.1 + 0.85 cos(π(i − 1/2)/m), in an order that
// keeps intermediate errors small. Sweeps after the coarse grid's correction gain more than those
// before it.
constexpr std::array kBefore = {0.909091F};
constexpr std::array kBeforeFromZero = {0.587875F, 2.004172F};
constexpr std::array kAfter = {0.530420F, 3.177605F, 0.701616F, 1.290790F};
constexpr int kBottomCells = 5;   // the most along an edge of a level solved by sweeps alone
constexpr int kSerialCells = 16;  // below this a region costs more than it saves

/// Sets p to 0 where the fine level is closed, e.g. in cells that a hand covers now.
void clear_closed(const PressureLevel& level, Field& p, int k) {
  for (int j = 0; j < level.grid.n; ++j) {
    const RowSpan s = level.span(j, k);
    const Index c = level.grid.index(0, j, k);
    for (int i = s.begin; i < s.end; ++i) {
      if (level.inverse[c + i] == 0.0F) p[c + i] = 0.0F;
    }
  }
}

/// Gives closed cells the mean of their open neighbours, so that interpolation near a hand reads
/// fluid only.
void extend_into_closed(const PressureLevel& level, Field& p) {
  constexpr int kNeighbours[6][3] = {{-1, 0, 0}, {1, 0, 0},  {0, -1, 0},
                                     {0, 1, 0},  {0, 0, -1}, {0, 0, 1}};
  for (int k = level.box.lower[2]; k < level.box.upper[2]; ++k) {
    for (int j = level.box.lower[1]; j < level.box.upper[1]; ++j) {
      const RowSpan s = level.span(j, k);
      const int end = std::min<int>(s.end, level.box.upper[0]);
      for (int i = std::max<int>(s.begin, level.box.lower[0]); i < end; ++i) {
        const Index c = level.grid.index(i, j, k);
        if (level.inverse[c] != 0.0F) continue;
        float sum = 0.0F, count = 0.0F;
        for (const auto& o : kNeighbours) {
          if (level.inverse_at(i + o[0], j + o[1], k + o[2]) == 0.0F) continue;
          sum += p[level.grid.index(i + o[0], j + o[1], k + o[2])];
          count += 1.0F;
        }
        p[c] = count > 0.0F ? sum / count : 0.0F;
      }
    }
  }
}

}  // namespace

PressureSolver::PressureSolver(int n, WorkerPool& pool, const PressureKernels& kernels)
    : pool_(pool), kernels_(kernels), convergence_(PaddedGrid{n}) {
  levels_.emplace_back(n);
  // a level of odd n is one cell longer than its parents, whose halo of zeros stands for the open
  // side there
  float across = static_cast<float>(n);  // the box, in cells of a level
  while (n > kBottomCells) {
    n /= 2;
    across /= 2.0F;
    levels_.emplace_back(n, across - static_cast<float>(n) + 0.5F);
  }
}

void PressureSolver::rebuild() {
  for (std::size_t l = 1; l < levels_.size(); ++l)
    levels_[l].problem.coarsen_from(levels_[l - 1].problem);
  const PressureLevel& level = fine();
  for (int k = level.box.lower[2]; k < level.box.upper[2]; ++k) clear_closed(level, pressure(), k);
}

template <class F>
void PressureSolver::over_planes(int n, F&& f) {
  if (n <= kSerialCells) {
    f(0, n);
    return;
  }
  fluid::over_planes(pool_, n, f);
}

void PressureSolver::smooth(Level& level, std::span<const float> omegas) {
  for (const float omega : omegas) {
    over_planes(level.problem.grid.n, [&](int k0, int k1) {
      kernels_.smooth(level.problem, level.p.data(), level.b.data(), omega, level.q.data(), k0, k1);
    });
    std::swap(level.p, level.q);
  }
}

void PressureSolver::smooth_from_zero(Level& level, std::span<const float> omegas) {
  // the first sweep starts from 0, so neighbours contribute nothing
  over_planes(level.problem.grid.n, [&](int k0, int k1) {
    kernels_.smooth_zero(level.problem, level.b.data(), omegas.front(), level.p.data(), k0, k1);
  });
  smooth(level, omegas.subspan(1));
}

void PressureSolver::v_cycle(std::size_t l, bool from_zero) {
  Level& level = levels_[l];
  if (l + 1 == levels_.size()) {
    if (from_zero) level.p.fill(0.0F);
    solve_bottom(level);
    return;
  }
  if (from_zero) {
    smooth_from_zero(level, kBeforeFromZero);
  } else {
    smooth(level, kBefore);
  }
  // the coarse grid's correction
  Level& coarse = levels_[l + 1];
  over_planes(coarse.problem.grid.n, [&](int k0, int k1) {
    kernels_.restrict_residual(level.problem, level.p.data(), level.b.data(), coarse.problem,
                               coarse.b.data(), k0, k1);
  });
  v_cycle(l + 1, true);
  extend_into_closed(coarse.problem, coarse.p);
  over_planes(level.problem.grid.n, [&](int k0, int k1) {
    kernels_.prolong_add(coarse.problem, coarse.p.data(), level.problem, level.p.data(), k0, k1);
  });
  smooth(level, kAfter);
}

void PressureSolver::solve_bottom(Level& level) {
  const PressureLevel& problem = level.problem;
  const int n = problem.grid.n, cells = n * n * n;
  const Index row = problem.grid.row(), plane = problem.grid.plane();
  const Field* a = problem.open;
  // symmetric sweeps, as many as leave less than a tenth of the smoothest error
  const int sweeps = 2 * std::max(8, n * n / 6);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (int m = 0; m < cells; ++m) {
      const int cell = sweep % 2 == 0 ? m : cells - 1 - m;
      const Index c = problem.grid.index(cell % n, cell / n % n, cell / (n * n));
      const Field& p = level.p;
      const float sum = a[0][c] * p[c - 1] + a[0][c + 1] * p[c + 1] + a[1][c] * p[c - row] +
                        a[1][c + row] * p[c + row] + a[2][c] * p[c - plane] +
                        a[2][c + plane] * p[c + plane];
      level.p[c] = problem.inverse[c] * (level.b[c] + sum);
    }
  }
}

/// Runs the iterations, and compares the last two.
template <class Iteration>
void PressureSolver::iterate(int times, const Iteration& iteration) {
  convergence_.begin();
  for (int left = times; left > 0; --left) {
    if (left <= 2) convergence_.keep(fine(), pressure());
    iteration();
    if (left <= 2) convergence_.compare(fine(), pressure());
  }
}

void PressureSolver::v_cycles(int cycles) {
  iterate(cycles, [this] { v_cycle(0, false); });
}

void PressureSolver::jacobi(int sweeps, bool warm) {
  Level& level = levels_.front();
  if (!warm) level.p.fill(0.0F);
  constexpr std::array kPlain = {1.0F};
  iterate(sweeps, [&] { smooth(level, kPlain); });
}

}  // namespace prostm::fluid
