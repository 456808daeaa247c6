#pragma once
/// Solves the Poisson problem of a step: warm-started V-cycles, or plain Jacobi sweeps as in the
/// paper.

#include <span>
#include <vector>

#include "prostm/core/worker_pool.hpp"
#include "prostm/fluid/detail/pressure/convergence.hpp"
#include "prostm/fluid/detail/pressure/pressure_kernels.hpp"

namespace prostm::fluid {

/// The hierarchy n, n/2, … down to at most 5 cells, each rounded down, and the solvers on it.
/// See docs/design/fluid.md. Every result is independent of the number of threads, to the bit.
class PressureSolver {
 public:
  PressureSolver(int n, WorkerPool& pool, const PressureKernels& kernels);

  /// The fine level, whose fractions the caller sets; then rebuild() makes the coarser ones.
  PressureLevel& fine() { return levels_.front().problem; }
  const PressureLevel& fine() const { return levels_.front().problem; }
  void rebuild();

  Field& pressure() { return levels_.front().p; }
  const Field& pressure() const { return levels_.front().p; }
  /// b of (F6); 0 in closed cells.
  Field& right_side() { return levels_.front().b; }

  /// Runs V-cycles from the pressure of the last call (F7)–(F10).
  void v_cycles(int cycles);
  /// Runs Jacobi sweeps, from the pressure of the last call or from 0.
  void jacobi(int sweeps, bool warm);

  // for ConjugateGradients
  /// Replaces the pressure by one V-cycle from 0 for the right side.
  void v_cycle_from_zero() { v_cycle(0, true); }
  const PressureKernels& kernels() const { return kernels_; }
  /// Convergence of the last solve.
  Convergence& convergence() { return convergence_; }

 private:
  struct Level {
    explicit Level(int n, float last_to_side = 0.5F)
        : problem(n, last_to_side), p(problem.grid), q(problem.grid), b(problem.grid) {}
    PressureLevel problem;
    Field p, q, b;  // unknown, its next iterate, right side
  };
  template <class F>
  void over_planes(int n, F&& f);
  void smooth(Level& level, std::span<const float> omegas);
  void smooth_from_zero(Level& level, std::span<const float> omegas);
  void v_cycle(std::size_t l, bool from_zero);
  void solve_bottom(Level& level);
  template <class Iteration>
  void iterate(int times, const Iteration& iteration);

  WorkerPool& pool_;
  const PressureKernels& kernels_;
  std::vector<Level> levels_;
  Convergence convergence_;
};

}  // namespace prostm::fluid
