#pragma once
/// Conjugate gradients with a V-cycle as preconditioner (MGPCG).

#include <vector>

#include "prostm/fluid/detail/pressure/pressure_solver.hpp"

namespace prostm::fluid {

/// McAdams, Sifakis, Teran 2010, in the flexible form (Notay 2000), since the V-cycle is not quite
/// symmetric: it restricts by sums and interpolates trilinearly. Every result is independent of the
/// number of threads, to the bit.
class ConjugateGradients {
 public:
  /// @param solver whose problem is solved; must outlive this object, as must `pool`.
  ConjugateGradients(PressureSolver& solver, WorkerPool& pool);

  /// Iterates from the solver's pressure, with one V-cycle per iteration. Leaves the residual in
  /// the solver's right side.
  void solve(int iterations);

 private:
  double dot(const Field& x, const Field& y);
  void apply(const Field& x, Field& out);
  void add(double factor, const Field& x, Field& to);

  PressureSolver& solver_;
  WorkerPool& pool_;
  PaddedGrid grid_;
  Field pressure_, direction_, image_;  // x, d and A d
  std::vector<double> sums_;            // one per plane, so that totals do not depend on threads
};

}  // namespace prostm::fluid
