/// The pressure equation and its solvers, without a fluid.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "analytic_raster.hpp"
#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"
#include "prostm/fluid/detail/advection.hpp"
#include "prostm/fluid/detail/obstacle.hpp"
#include "prostm/fluid/detail/pressure/conjugate_gradients.hpp"
#include "prostm/fluid/detail/pressure/pressure_solver.hpp"
#include "prostm/fluid/detail/pressure/projection.hpp"

namespace prostm::fluid {
namespace {

GridShape unit_grid(int n) {
  GridShape grid;
  grid.nx = grid.ny = grid.nz = n;
  grid.cell = 1.0 / n;
  grid.p_DF = Vec3(-0.5, -0.5, 0.0);
  return grid;
}

HandRaster ball(int n, const Vec3& velocity = Vec3::Zero()) {
  return test::shape_raster(
      unit_grid(n), [](const Vec3& p) { return test::sphere(p, Vec3(0.03, -0.05, 0.52), 0.22); },
      velocity);
}

void fill_random(const PaddedGrid& grid, Field& field, Random& random) {
  for (int k = 0; k < grid.n; ++k) {
    for (int j = 0; j < grid.n; ++j) {
      for (int i = 0; i < grid.n; ++i)
        field[grid.index(i, j, k)] = static_cast<float>(random.uniform(-1.0, 1.0));
    }
  }
}

/// Clears the right-hand side of cells without an equation.
void clear_closed(const Obstacle& obstacle, PressureSolver& solver) {
  const PaddedGrid& grid = solver.fine().grid;
  for (Index c = grid.index(0, 0, 0); c < grid.index(0, 0, grid.n); ++c) {
    if (obstacle.closed(c)) solver.right_side()[c] = 0.0F;
  }
}

double largest_difference(const PaddedGrid& grid, const Field& a, const Field& b, int extent) {
  double most = 0.0;
  for (int k = 0; k < extent; ++k) {
    for (int j = 0; j < extent; ++j) {
      for (int i = 0; i < extent; ++i) {
        const Index c = grid.index(i, j, k);
        most = std::max(most, std::abs(static_cast<double>(a[c]) - static_cast<double>(b[c])));
      }
    }
  }
  return most;
}

/// Solves (F6) in doubles in an open box over a floor, without a hand: its modes are sines across
/// the open sides and, along z, cosines of odd quarter waves, each with its own eigenvalue.
class OpenBox {
 public:
  explicit OpenBox(int n) : n_(n), across_(modes(0.0)), up_(modes(0.5)) {}

  /// @return the pressure for the right-hand side b, both with x fastest.
  std::vector<double> solve(std::vector<double> b) const {
    for (int axis = 0; axis < 3; ++axis) transform(axis, false, b);
    for (int m = 0; m < n_ * n_ * n_; ++m) {
      const double sum = eigenvalue(m % n_ + 1.0) + eigenvalue(m / n_ % n_ + 1.0) +
                         eigenvalue(m / (n_ * n_) + 0.5);
      b[static_cast<std::size_t>(m)] /= sum;
    }
    for (int axis = 0; axis < 3; ++axis) transform(axis, true, b);
    return b;
  }

 private:
  double eigenvalue(double wave) const { return 2.0 - 2.0 * std::cos(kPi * wave / n_); }
  /// Orthonormal modes in rows: sines, or cosines for a shift of half a wave.
  std::vector<double> modes(double shift) const {
    std::vector<double> all(static_cast<std::size_t>(n_ * n_));
    for (int m = 0; m < n_; ++m) {
      double squares = 0.0;
      for (int i = 0; i < n_; ++i) {
        const double angle = kPi * (m + 1.0 - shift) * (i + 0.5) / n_;
        const double value = shift > 0.0 ? std::cos(angle) : std::sin(angle);
        all[at(m, i)] = value;
        squares += value * value;
      }
      for (int i = 0; i < n_; ++i) all[at(m, i)] /= std::sqrt(squares);
    }
    return all;
  }
  void transform(int axis, bool back, std::vector<double>& field) const {
    const std::vector<double>& basis = axis == 2 ? up_ : across_;
    const auto n = static_cast<std::size_t>(n_);
    const std::size_t stride = axis == 0 ? 1 : axis == 1 ? n : n * n;
    std::vector<double> line(n);
    for (std::size_t c = 0; c < field.size(); ++c) {
      if (c / stride % n != 0) continue;  // only where a line begins
      for (std::size_t m = 0; m < n; ++m) {
        line[m] = 0.0;
        for (std::size_t i = 0; i < n; ++i)
          line[m] += (back ? basis[i * n + m] : basis[m * n + i]) * field[c + i * stride];
      }
      for (std::size_t m = 0; m < n; ++m) field[c + m * stride] = line[m];
    }
  }
  std::size_t at(int m, int i) const { return static_cast<std::size_t>(m * n_ + i); }

  int n_;
  std::vector<double> across_, up_;
};

/// Relative rms difference to a solution in doubles with x fastest.
double relative_error(const PaddedGrid& grid, const Field& p, const std::vector<double>& exact) {
  double error = 0.0, norm = 0.0;
  for (int c = 0; c < grid.n * grid.n * grid.n; ++c) {
    const double is =
        static_cast<double>(p[grid.index(c % grid.n, c / grid.n % grid.n, c / (grid.n * grid.n))]);
    error += std::pow(is - exact[static_cast<std::size_t>(c)], 2);
    norm += std::pow(exact[static_cast<std::size_t>(c)], 2);
  }
  return std::sqrt(error / norm);
}

TEST(Pressure, AgreesWithTheCosineTransform) {
  for (const int n : {32, 36, 45, 47, 48, 64, 100}) {
    WorkerPool pool(2);
    PressureSolver solver(n, pool, fast_pressure_kernels());
    ConjugateGradients conjugate_gradients(solver, pool);
    const PaddedGrid& grid = solver.fine().grid;
    Random random(static_cast<std::uint64_t>(n));
    fill_random(grid, solver.right_side(), random);
    std::vector<double> b(static_cast<std::size_t>(n * n * n));
    for (int c = 0; c < n * n * n; ++c)
      b[static_cast<std::size_t>(c)] =
          static_cast<double>(solver.right_side()[grid.index(c % n, c / n % n, c / (n * n))]);
    const std::vector<double> exact = OpenBox(n).solve(b);
    solver.v_cycles(20);
    EXPECT_LT(relative_error(grid, solver.pressure(), exact), 1e-5) << n;
    solver.pressure().fill(0.0F);
    conjugate_gradients.solve(12);
    EXPECT_LT(relative_error(grid, solver.pressure(), exact), 1e-5) << n;
  }
}

/// A solver for the ball with a random right-hand side.
struct BallProblem {
  BallProblem(int n, int threads)
      : pool(threads),
        obstacle(n, pool),
        solver(n, pool, fast_pressure_kernels()),
        cg(solver, pool) {
    obstacle.update(ball(n), solver.fine());
    solver.rebuild();
    Random random(2);
    fill_random(solver.fine().grid, solver.right_side(), random);
    clear_closed(obstacle, solver);
  }
  WorkerPool pool;
  Obstacle obstacle;
  PressureSolver solver;
  ConjugateGradients cg;
};

TEST(Pressure, ConjugateGradientsNeedFewerCycles) {
  for (const int n : {32, 48, 50, 80, 100}) {
    BallProblem exact(n, 2), cycles(n, 2), cg(n, 2);
    exact.solver.v_cycles(25);
    const auto error = [&](BallProblem& p) {
      return largest_difference(exact.solver.fine().grid, p.solver.pressure(),
                                exact.solver.pressure(), n);
    };
    cycles.solver.v_cycles(4);
    cg.cg.solve(4);
    EXPECT_LT(error(cg), 0.3 * error(cycles)) << n;
  }
}

TEST(Pressure, ConjugateGradientsDoNotDependOnThreads) {
  constexpr int n = 48;
  BallProblem one(n, 1), three(n, 3);
  one.cg.solve(4);
  three.cg.solve(4);
  EXPECT_EQ(
      largest_difference(one.solver.fine().grid, one.solver.pressure(), three.solver.pressure(), n),
      0.0);
}

TEST(Pressure, ConjugateGradientsStopAtTheSolution) {
  BallProblem problem(32, 1);
  problem.solver.right_side().fill(0.0F);
  problem.cg.solve(3);
  const PaddedGrid& grid = problem.solver.fine().grid;
  EXPECT_EQ(largest_difference(grid, problem.solver.pressure(), Field(grid), 32), 0.0);
  EXPECT_EQ(problem.solver.convergence().error(), 0.0);
}

TEST(Pressure, CyclesContractAtEverySize) {
  for (const int n : {32, 36, 45, 47, 48, 64, 80, 100, 112, 124, 132, 144}) {
    WorkerPool pool(2);
    Obstacle obstacle(n, pool);
    PressureSolver solver(n, pool, fast_pressure_kernels());
    obstacle.update(ball(n), solver.fine());
    solver.rebuild();
    Random random(2);
    fill_random(solver.fine().grid, solver.right_side(), random);
    clear_closed(obstacle, solver);
    PressureSolver exact(n, pool, fast_pressure_kernels());
    obstacle.update(ball(n), exact.fine());
    exact.rebuild();
    exact.right_side().copy_from(solver.right_side());
    exact.v_cycles(25);
    solver.v_cycles(2);
    const double two =
        largest_difference(solver.fine().grid, solver.pressure(), exact.pressure(), n);
    solver.v_cycles(2);
    const double four =
        largest_difference(solver.fine().grid, solver.pressure(), exact.pressure(), n);
    EXPECT_LT(four, 0.2 * two) << n;
  }
}

TEST(Pressure, JacobiReachesTheSamePressure) {
  constexpr int n = 32;
  WorkerPool pool(1);
  Obstacle obstacle(n, pool);
  PressureSolver cycles(n, pool, fast_pressure_kernels()), sweeps(n, pool, fast_pressure_kernels());
  for (PressureSolver* solver : {&cycles, &sweeps}) {
    obstacle.update(ball(n), solver->fine());
    solver->rebuild();
    Random random(3);
    fill_random(solver->fine().grid, solver->right_side(), random);
    clear_closed(obstacle, *solver);
  }
  cycles.v_cycles(20);
  sweeps.jacobi(4000, false);
  EXPECT_LT(largest_difference(cycles.fine().grid, cycles.pressure(), sweeps.pressure(), n), 2e-4);
  // warm sweeps continue from there; cold sweeps start from zero
  sweeps.jacobi(1, true);
  EXPECT_LT(largest_difference(cycles.fine().grid, cycles.pressure(), sweeps.pressure(), n), 2e-4);
  sweeps.jacobi(1, false);
  EXPECT_GT(largest_difference(cycles.fine().grid, cycles.pressure(), sweeps.pressure(), n), 0.1);
}

TEST(Pressure, VectorKernelsAgreeWithPlainOnes) {
  WorkerPool pool(1);
  for (const int n : {32, 33, 36, 45, 48, 64}) {
    PressureSolver solver(n, pool, scalar_pressure_kernels());
    Obstacle obstacle(n, pool);
    obstacle.update(ball(n), solver.fine());
    const PressureLevel& fine = solver.fine();
    PressureLevel coarse(n / 2, n % 2 == 0 ? 0.5F : 1.0F);
    coarse.coarsen_from(fine);
    Random random(4);
    Field p(fine.grid), b(fine.grid), slow(fine.grid), fast(fine.grid), e(coarse.grid),
        slow_b(coarse.grid), fast_b(coarse.grid);
    fill_random(fine.grid, p, random);
    fill_random(fine.grid, b, random);
    fill_random(coarse.grid, e, random);
    const PressureKernels &s = scalar_pressure_kernels(), &f = fast_pressure_kernels();
    s.smooth(fine, p.data(), b.data(), 0.7F, slow.data(), 0, n);
    f.smooth(fine, p.data(), b.data(), 0.7F, fast.data(), 0, n);
    EXPECT_LT(largest_difference(fine.grid, slow, fast, n), 1e-5);
    s.smooth_zero(fine, b.data(), 0.7F, slow.data(), 0, n);
    f.smooth_zero(fine, b.data(), 0.7F, fast.data(), 0, n);
    EXPECT_LT(largest_difference(fine.grid, slow, fast, n), 1e-5);
    s.apply(fine, p.data(), slow.data(), 0, n);
    f.apply(fine, p.data(), fast.data(), 0, n);
    EXPECT_LT(largest_difference(fine.grid, slow, fast, n), 1e-5);
    s.restrict_residual(fine, p.data(), b.data(), coarse, slow_b.data(), 0, n / 2);
    f.restrict_residual(fine, p.data(), b.data(), coarse, fast_b.data(), 0, n / 2);
    EXPECT_LT(largest_difference(coarse.grid, slow_b, fast_b, n / 2), 2e-5);
    slow.copy_from(p);
    fast.copy_from(p);
    s.prolong_add(coarse, e.data(), fine, slow.data(), 0, n);
    f.prolong_add(coarse, e.data(), fine, fast.data(), 0, n);
    EXPECT_LT(largest_difference(fine.grid, slow, fast, n), 1e-5);
    EXPECT_GT(largest_difference(fine.grid, p, fast, n), 0.1);
  }
}

TEST(Advection, VectorKernelsAgreeWithPlainOnes) {
  // 9 cells per step are too rough for blocks; rows of 45 are not a multiple of the vector length
  for (const auto& [n, speed] :
       {std::pair(32, 0.3), std::pair(32, 2.0), std::pair(32, 9.0), std::pair(45, 2.0)}) {
    const PaddedGrid grid{n};
    Random random(5);
    Field u[3] = {Field(grid), Field(grid), Field(grid)};
    for (Field& x : u) {
      fill_random(grid, x, random);
      for (Index c = 0; c < grid.size(); ++c) x[c] *= static_cast<float>(speed);
    }
    Field field(grid);
    fill_random(grid, field, random);
    const AdvectionKernels* kernels[2] = {&scalar_advection_kernels(), &fast_advection_kernels()};
    Displacements moved[2] = {Displacements(grid), Displacements(grid)};
    const float* const from[3] = {u[0].data(), u[1].data(), u[2].data()};
    for (int kind = 0; kind < 2; ++kind) kernels[kind]->trace(grid, from, moved[kind], 0, n);
    std::vector<Field> out[2];
    for (int kind = 0; kind < 2; ++kind) {
      for (int axis = -1; axis < 3; ++axis) {
        const Placement place = axis < 0 ? centre_placement(n) : face_placement(n, axis);
        out[kind].emplace_back(grid);
        // the same displacement for both: in rough fields a rounding error of it moves the sample
        kernels[kind]->sample(grid, place, moved[1], field.data(), out[kind].back().data(), 0,
                              axis == 2 ? n + 1 : n);
      }
    }
    for (int a = 0; a < 3; ++a) {
      EXPECT_LT(largest_difference(grid, moved[0].at[a], moved[1].at[a], n),
                1e-5 * (1.0 + speed * speed));
    }
    for (std::size_t f = 0; f < 4; ++f) {
      EXPECT_LT(largest_difference(grid, out[0][f], out[1][f], n + 1), 1e-5 * (1.0 + speed)) << f;
    }
  }
}

TEST(Advection, CarriesALinearFieldExactly) {
  constexpr int n = 32;
  const PaddedGrid grid{n};
  Field u[3] = {Field(grid, 1.3F), Field(grid, -0.4F), Field(grid, 2.2F)};
  Displacements moved(grid);
  Field in(grid), out(grid);
  const auto linear = [](double x, double y, double z) { return 0.1 * x - 0.2 * y + 0.05 * z; };
  for (int k = -1; k <= n; ++k) {
    for (int j = -1; j <= n; ++j) {
      for (int i = -1; i <= n; ++i) in[grid.index(i, j, k)] = static_cast<float>(linear(i, j, k));
    }
  }
  const float* const from[3] = {u[0].data(), u[1].data(), u[2].data()};
  fast_advection_kernels().trace(grid, from, moved, 0, n);
  fast_advection_kernels().sample(grid, centre_placement(n), moved, in.data(), out.data(), 0, n);
  for (int k = 4; k < n - 4; ++k) {
    for (int j = 4; j < n - 4; ++j) {
      for (int i = 4; i < n - 4; ++i) {
        EXPECT_NEAR(static_cast<double>(out[grid.index(i, j, k)]),
                    linear(i - 1.3, j + 0.4, k - 2.2), 2e-5);
      }
    }
  }
}

TEST(Obstacle, OpenFractionIsTheAreaOfTheSquare) {
  EXPECT_EQ(open_fraction(1.0F, 1.0F, 1.0F, 1.0F), 1.0F);
  EXPECT_EQ(open_fraction(-1.0F, -1.0F, -1.0F, 0.0F), 0.0F);
  EXPECT_FLOAT_EQ(open_fraction(-1.0F, 1.0F, 1.0F, -1.0F), 0.5F);
  // straight edges at any angle: the linear distance is cut exactly
  Random random(6);
  for (int trial = 0; trial < 200; ++trial) {
    const double angle = random.uniform(0.0, 6.28), offset = random.uniform(-0.5, 0.5);
    const auto distance = [&](double x, double y) {
      return std::cos(angle) * (x - 0.5) + std::sin(angle) * (y - 0.5) + offset;
    };
    int inside = 0;
    for (int s = 0; s < 400; ++s) {
      for (int t = 0; t < 400; ++t) inside += distance((s + 0.5) / 400, (t + 0.5) / 400) > 0.0;
    }
    const auto at = [&](int x, int y) { return static_cast<float>(distance(x, y)); };
    const double fraction =
        static_cast<double>(open_fraction(at(0, 0), at(1, 0), at(1, 1), at(0, 1)));
    EXPECT_NEAR(fraction, inside / 160000.0, inside / 160000.0 < 0.021 ? 0.021 : 2e-3);
  }
}

TEST(Projection, LeavesNoDivergenceAndNoFlowThroughWalls) {
  constexpr int n = 48;
  WorkerPool pool(2);
  Obstacle obstacle(n, pool);
  PressureSolver solver(n, pool, fast_pressure_kernels());
  const Vec3 speed(0.3, -0.2, 0.5);
  obstacle.update(ball(n, speed), solver.fine());
  solver.rebuild();
  const PressureLevel& level = solver.fine();
  const PaddedGrid& grid = level.grid;
  Field u[3] = {Field(grid), Field(grid), Field(grid)};
  Random random(7);
  for (Field& x : u) fill_random(grid, x, random);
  std::fill_n(u[2].data() + grid.index(0, 0, 0), grid.row() * n, 0.0F);
  for (int k = 0; k < n; ++k) divergence(level, obstacle, u, k, -1.0F, solver.right_side().data());
  solver.v_cycles(25);
  for (int k = 0; k < n; ++k)
    subtract_gradient(level, obstacle, solver.pressure().data(), 1.0F, u, k);

  // recomputed cell by cell in double and compared with divergence()
  double largest = 0.0, reported = 0.0, squares = 0.0, sum = 0.0;
  for (int k = 0; k < n; ++k) {
    const DivergenceSum plane = divergence(level, obstacle, u, k, 1.0F, nullptr);
    reported = std::max(reported, static_cast<double>(plane.largest));
    sum += plane.squares;
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const Index c = grid.index(i, j, k);
        if (obstacle.closed(c)) continue;
        double outflow = 0.0;
        for (int axis = 0; axis < 3; ++axis) {
          const auto flux = [&](Index f) {
            const auto a = static_cast<double>(level.open[axis][f]);
            const double wall = axis == 2 && f < grid.index(0, 0, 1) ? 0.0 : speed[axis];
            return a * static_cast<double>(u[axis][f]) + (1.0 - a) * wall;
          };
          outflow += flux(c + grid.stride(axis)) - flux(c);
        }
        largest = std::max(largest, std::abs(outflow));
        squares += outflow * outflow;
      }
    }
  }
  EXPECT_LT(largest, 2e-5);
  EXPECT_NEAR(reported, largest, 1e-6);
  EXPECT_NEAR(sum, squares, 1e-2 * squares);

  // no fluid passes a closed face, which moves with the wall
  int shut = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (int k = 1; k < n; ++k) {
      for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
          const Index c = grid.index(i, j, k);
          if (level.open[axis][c] > 0.0F) continue;
          ++shut;
          EXPECT_EQ(u[axis][c], static_cast<float>(speed[axis]));
        }
      }
    }
  }
  EXPECT_GT(shut, 1000);
}

TEST(Obstacle, SealedPocketsAreClosed) {
  constexpr int n = 48;
  WorkerPool pool(1);
  Obstacle obstacle(n, pool);
  PressureLevel level(n);
  const Vec3 centre(0.01, 0.02, 0.5);
  const auto shell = [&](const Vec3& p) { return std::abs(test::sphere(p, centre, 0.25)) - 0.04; };
  obstacle.update(test::shape_raster(unit_grid(n), shell), level);
  EXPECT_TRUE(obstacle.closed(level.grid.index(n / 2, n / 2, n / 2)));
  const int sealed = obstacle.closed_cells();
  // a hole reconnects inside and outside
  const auto holed = [&](const Vec3& p) {
    const double bore = std::hypot(p.x() - centre.x(), p.y() - centre.y()) - 0.08;
    return p.z() > centre.z() ? std::max(shell(p), -bore) : shell(p);
  };
  obstacle.update(test::shape_raster(unit_grid(n), holed), level);
  EXPECT_FALSE(obstacle.closed(level.grid.index(n / 2, n / 2, n / 2)));
  EXPECT_LT(obstacle.closed_cells(), sealed - 1000);
  // nothing remains once the hand is gone
  obstacle.update(test::empty_raster(unit_grid(n)), level);
  EXPECT_EQ(obstacle.closed_cells(), 0);
  for (int axis = 0; axis < 3; ++axis) {
    for (Index c = level.grid.index(0, 0, 1); c < level.grid.index(0, 0, n - 1); ++c)
      EXPECT_EQ(level.open[axis][c], 1.0F);
  }
}

}  // namespace
}  // namespace prostm::fluid
