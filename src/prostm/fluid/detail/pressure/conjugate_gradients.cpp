#include "prostm/fluid/detail/pressure/conjugate_gradients.hpp"

#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "prostm/fluid/detail/over_planes.hpp"

namespace prostm::fluid {
namespace {

/// Σ x y over plane k, in 16 lanes: the compiler may use vectors of any width, and the result stays
/// the same.
double plane_dot(const PaddedGrid& grid, const Field& x, const Field& y, int k) {
  double sum = 0.0;
  for (int j = 0; j < grid.n; ++j) {
    std::array<float, PaddedGrid::kLane> lanes{};
    const float *a = x.data() + grid.index(0, j, k), *b = y.data() + grid.index(0, j, k);
    for (Index i = 0; i < grid.width(); i += PaddedGrid::kLane) {
      for (Index lane = 0; lane < PaddedGrid::kLane; ++lane)
        lanes[static_cast<std::size_t>(lane)] += a[i + lane] * b[i + lane];
    }
    for (const float lane : lanes) sum += static_cast<double>(lane);
  }
  return sum;
}

}  // namespace

ConjugateGradients::ConjugateGradients(PressureSolver& solver, WorkerPool& pool)
    : solver_(solver),
      pool_(pool),
      grid_(solver.fine().grid),
      pressure_(grid_),
      direction_(grid_),
      image_(grid_),
      sums_(static_cast<std::size_t>(grid_.n)) {}

double ConjugateGradients::dot(const Field& x, const Field& y) {
  over_planes(pool_, grid_.n, [&](int k0, int k1) {
    for (int k = k0; k < k1; ++k) sums_[static_cast<std::size_t>(k)] = plane_dot(grid_, x, y, k);
  });
  return std::accumulate(sums_.begin(), sums_.end(), 0.0);
}

void ConjugateGradients::apply(const Field& x, Field& out) {
  over_planes(pool_, grid_.n, [&](int k0, int k1) {
    solver_.kernels().apply(solver_.fine(), x.data(), out.data(), k0, k1);
  });
}

/// to += factor x.
void ConjugateGradients::add(double factor, const Field& x, Field& to) {
  const auto f = static_cast<float>(factor);
  over_planes(pool_, grid_.n, [&](int k0, int k1) {
    for (Index c = grid_.index(0, 0, k0); c < grid_.index(0, 0, k1); ++c) to[c] += f * x[c];
  });
}

void ConjugateGradients::solve(int iterations) {
  Field &residual = solver_.right_side(), &correction = solver_.pressure();
  Convergence& convergence = solver_.convergence();
  convergence.begin();
  std::swap(pressure_, correction);  // the V-cycle needs the solver's field
  apply(pressure_, image_);
  add(-1.0, image_, residual);
  solver_.v_cycle_from_zero();
  direction_.copy_from(correction);
  double descent = dot(residual, correction);
  for (int iteration = 1;; ++iteration) {
    apply(direction_, image_);
    const double curvature = dot(direction_, image_);
    // converged, or not finite
    if (!std::isnormal(curvature) || !std::isnormal(descent)) break;
    const double step = descent / curvature;
    if (iteration + 1 >= iterations) convergence.keep(solver_.fine(), pressure_);
    add(step, direction_, pressure_);
    if (iteration + 1 >= iterations) convergence.compare(solver_.fine(), pressure_);
    add(-step, image_, residual);
    if (iteration == iterations) break;
    solver_.v_cycle_from_zero();
    // Polak and Ribière's quotient, where r_new − r_old = −step A d
    const double turn = -step * dot(correction, image_) / descent;
    descent = dot(residual, correction);
    over_planes(pool_, grid_.n, [&](int k0, int k1) {
      const auto beta = static_cast<float>(turn);
      for (Index c = grid_.index(0, 0, k0); c < grid_.index(0, 0, k1); ++c)
        direction_[c] = correction[c] + beta * direction_[c];
    });
  }
  std::swap(pressure_, correction);
}

}  // namespace prostm::fluid
