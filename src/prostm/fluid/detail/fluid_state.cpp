#include "prostm/fluid/detail/fluid_state.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "prostm/core/stage_timer.hpp"
#include "prostm/fluid/detail/bytes.hpp"
#include "prostm/fluid/detail/carry_over.hpp"
#include "prostm/fluid/detail/extrapolation.hpp"
#include "prostm/fluid/detail/forces.hpp"
#include "prostm/fluid/detail/largest.hpp"
#include "prostm/fluid/detail/over_planes.hpp"
#include "prostm/fluid/detail/settings.hpp"
#include "prostm/fluid/detail/viscosity.hpp"

namespace prostm {

using fluid::Field;
using fluid::Index;

namespace {

static_assert(FluidSettings::kMostCells <= fluid::PressureLevel::kMaxCells);

constexpr float kAbsurd = 1e6F;  // [m/s]; a state with a larger value is unusable

/// y ← a x + b y
void blend(float a, const float* x, float b, float* y, Index count) {
  for (Index i = 0; i < count; ++i) y[i] = a * x[i] + b * y[i];
}

GridShape grid_shape(const FluidSettings& settings) {
  fluid::validate(settings);
  GridShape grid;
  grid.nx = grid.ny = grid.nz = settings.cells;
  grid.cell = settings.width / settings.cells;
  grid.p_DF = Vec3(-0.5 * settings.width, -0.5 * settings.width, 0.0);
  return grid;
}

}  // namespace

Fluid::State::State(const FluidSettings& s, const SmokeInflow& from, WorkerPool& workers)
    : settings(s),
      pool(workers),
      grid(grid_shape(s)),
      home(grid.p_DF),
      padded{s.cells},
      inflow(fluid::blown(from, s.jet_speed)),
      surroundings(grid, inflow),
      velocity{Field(padded), Field(padded), Field(padded)},
      smoke(padded),
      obstacle(s.cells, workers, s.hand),
      solver(s.cells, workers, fluid::fast_pressure_kernels()),
      acting(padded),
      next_velocity{Field(padded), Field(padded), Field(padded)},
      next_smoke(padded),
      moved(padded),
      shut{fluid::ShutFaces(padded), fluid::ShutFaces(padded), fluid::ShutFaces(padded)},
      sums(static_cast<std::size_t>(s.cells)),
      pressure_out(grid.cell_count()),
      fluid_cells(grid.cell_count(), 1) {
  if (s.solver == PressureMethod::Mgpcg) conjugate_gradients.emplace(solver, pool);
  surroundings.set_floor(obstacle.wall_velocity(2));
  reset();
}

void Fluid::State::reset() {
  for (Field& u : velocity) u.fill(0.0F);
  smoke.fill(0.0F);
  solver.pressure().fill(0.0F);
  std::fill(pressure_out.begin(), pressure_out.end(), 0.0F);
  surroundings.set_floor(velocity[2]);  // the jets blow from the first step on
  acting.fill(0.0F);
  fastest = early = 0.0;
}

void Fluid::State::move_box(const CellShift& by) {
  if (by == CellShift{}) return;
  bool is_far = false;
  for (std::size_t a = 0; a < by.size(); ++a) {
    shift[a] += by[a];
    is_far = is_far || 2 * std::abs(by[a]) >= padded.n;
  }
  grid.p_DF = home + grid.cell * Vec3(shift[0], shift[1], shift[2]);
  surroundings.place(grid, inflow);
  surroundings.set_floor(obstacle.wall_velocity(2));
  if (is_far) return reset();
  for (int axis = 0; axis < 3; ++axis) fluid::carry_over(padded, by, axis, velocity[axis]);
  fluid::carry_over(padded, by, 3, smoke);
  fluid::carry_over(padded, by, 3, solver.pressure());
  fluid::carry_over(padded, by, 3, acting);
  surroundings.set_floor(velocity[2]);
}

template <class F>
void Fluid::State::over_planes(F&& f) {
  fluid::over_planes(pool, padded.n, f);
}

void Fluid::State::prepare(double step_dt) {
  const StageTimer timer;
  dt = step_dt / settings.substeps;
  stats = {};
  usable = std::isfinite(dt) && dt > 0.0;
  for (int sub = 1; sub <= settings.substeps && usable; ++sub) {
    // the mean pressure over the step starts with the early share of the first sub-step
    keep = sub > 1 ? 1.0F : 0.0F;
    advect();
    add_forces();
    if (sub < settings.substeps) finish_substep();
  }
  stats.advect = stats.total = timer.seconds();
}

void Fluid::State::meet(const HandRaster& raster) {
  const StageTimer total;
  StageTimer stage;
  usable = usable && raster.grid == grid && fluid::is_finite(raster, pool);
  if (usable) {
    place_hands(raster);
    stats.hand = stage.lap();
    solve();
    stats.solve = stage.lap();
    usable = publish();
  }
  if (!usable) reset();
  stats.total += total.seconds();
}

/// Whether pressures of several times act in one step.
bool Fluid::State::is_split() const {
  return settings.substeps > 1 || settings.theta < 1.0;
}

/// Returns the weight of a pressure that acts for this share of a sub-step, in the mean over the
/// step.
float Fluid::State::weight(double share) const {
  return static_cast<float>(share / settings.substeps);
}

/// Lets a share of the last pressure act before the particles move (F17), in planes [k0, k1).
void Fluid::State::press_early(int k0, int k1) {
  const auto factor = static_cast<float>(early * dt / (settings.density * grid.cell));
  const float* const pressure = solver.pressure().data();
  for (int k = k0; k < k1 && early > 0.0; ++k)
    fluid::subtract_gradient(solver.fine(), obstacle, pressure, factor, velocity, k);
  const Index c = padded.index(0, 0, k0);
  blend(weight(early), pressure + c, keep, acting.data() + c, (k1 - k0) * padded.plane());
}

/// Finishes a sub-step with the hands of the previous step.
void Fluid::State::finish_substep() {
  solve();
  over_planes([&](int k0, int k1) {
    const Index c = padded.index(0, 0, k0);
    blend(weight(1.0 - early), solver.pressure().data() + c, 1.0F, acting.data() + c,
          (k1 - k0) * padded.plane());
  });
  usable = project();
  if (usable) extend_into_hands();
}

void Fluid::State::extend_into_hands() {
  pool.run(3, [&](int axis) { fluid::extend_into_hands(shut[axis], velocity[axis]); });
}

FluidStats Fluid::State::settle() {
  const StageTimer timer;
  const double before = stats.total;
  if (usable) {
    usable = project();
    stats.solve += timer.seconds();
    if (!usable) reset();
  }
  if (usable) {
    measure();
    extend_into_hands();
  } else {
    stats = {};
    stats.reset = true;
  }
  stats.solid_cells = obstacle.closed_cells();
  stats.total = before + timer.seconds();
  return stats;
}

/// The share of the pressure that acts before the particles move. Beyond some cells a step the
/// centred form is not stable.
double Fluid::State::early_share() const {
  constexpr double kStable = 6.0, kUnstable = 10.0;  // [cells per sub-step]
  const double speed = fastest * dt / grid.cell;
  return (1.0 - settings.theta) * std::clamp((kUnstable - speed) / (kUnstable - kStable), 0.0, 1.0);
}

void Fluid::State::advect() {
  const int n = padded.n;
  const auto scale = static_cast<float>(dt / grid.cell);
  Field* const centre = next_velocity;  // until the next velocity is written
  const fluid::AdvectionKernels& kernels = fluid::fast_advection_kernels();
  over_planes([&](int k0, int k1) {
    for (int k = k0; k < k1; ++k) fluid::centre_velocity(padded, velocity, scale, centre, k);
  });
  // displacements of the particles
  const float* const from[3] = {centre[0].data(), centre[1].data(), centre[2].data()};
  early = early_share();
  over_planes([&](int k0, int k1) {
    kernels.trace(padded, from, moved, k0, k1);
    if (is_split()) press_early(k0, k1);
  });
  if (early > 0.0) extend_into_hands();
  surroundings.set_smoke_halo(smoke);
  // the advected values
  over_planes([&](int k0, int k1) {
    for (int axis = 0; axis < 3; ++axis) {
      const int faces = axis == 2 && k1 == n ? n + 1 : k1;
      kernels.sample(padded, fluid::face_placement(n, axis), moved, velocity[axis].data(),
                     next_velocity[axis].data(), k0, faces);
    }
    kernels.sample(padded, fluid::centre_placement(n), moved, smoke.data(), next_smoke.data(), k0,
                   k1);
  });
  for (int axis = 0; axis < 3; ++axis) std::swap(velocity[axis], next_velocity[axis]);
  std::swap(smoke, next_smoke);
  surroundings.calm_inflow(pool, velocity);
  surroundings.set_floor(velocity[2]);
}

/// (F13), in as many passes as keep it stable.
void Fluid::State::diffuse() {
  const double share = inflow.viscosity * dt / (grid.cell * grid.cell);
  const int passes = fluid::viscous_passes(share);
  const int n = padded.n;
  for (int pass = 0; pass < passes; ++pass) {
    over_planes([&](int k0, int k1) {
      for (int axis = 0; axis < 3; ++axis) {
        for (int k = k0; k < (axis == 2 && k1 == n ? n + 1 : k1); ++k) {
          fluid::diffuse(padded, axis, velocity[axis], static_cast<float>(share / passes),
                         next_velocity[axis], k);
        }
      }
    });
    for (int axis = 0; axis < 3; ++axis) std::swap(velocity[axis], next_velocity[axis]);
  }
}

void Fluid::State::add_forces() {
  constexpr double kBelowHand = 0.050;  // a tube that ends nearer would press on the hand [m]
  diffuse();
  surroundings.guide(pool, dt, lowest_hand - kBelowHand, velocity);
  const auto decay = static_cast<float>(std::exp(-settings.dissipation * dt));
  const auto lift = static_cast<float>(dt * settings.buoyancy);
  if (settings.dissipation > 0.0) {
    over_planes([&](int k0, int k1) {
      for (Index c = padded.index(0, 0, k0); c < padded.index(0, 0, k1); ++c) smoke[c] *= decay;
    });
  }
  if (settings.buoyancy > 0.0) {
    over_planes([&](int k0, int k1) {
      for (int k = k0; k < k1; ++k) fluid::add_buoyancy(padded, smoke, lift, velocity[2], k);
    });
  }
  if (settings.vorticity > 0.0) confine_vorticity();
}

void Fluid::State::confine_vorticity() {
  Field& magnitude = next_smoke;
  Field* const centre = next_velocity;
  const auto epsilon = static_cast<float>(settings.vorticity);
  const auto step = static_cast<float>(dt);
  over_planes([&](int k0, int k1) {
    for (int k = k0; k < k1; ++k) fluid::centre_velocity(padded, velocity, 1.0F, centre, k);
    for (Field& u : next_velocity) fluid::extend_plane(padded, u.data(), k0, k1);
  });
  over_planes([&](int k0, int k1) {
    for (int k = k0; k < k1; ++k) fluid::vorticity_magnitude(padded, centre, magnitude, k);
    fluid::extend_plane(padded, magnitude.data(), k0, k1);
  });
  over_planes([&](int k0, int k1) {
    for (int k = k0; k < k1; ++k)
      fluid::confinement_force(padded, centre, magnitude, epsilon, moved.at, k);
  });
  over_planes([&](int k0, int k1) {
    for (int k = k0; k < k1; ++k) fluid::add_centred_force(padded, moved.at, step, velocity, k);
  });
  // the scratch doubles as the next smoke, whose halo must be clear air
  magnitude.fill(0.0F);
}

void Fluid::State::place_hands(const HandRaster& raster) {
  obstacle.update(raster, solver.fine());
  lowest_hand = fluid::lowest_of(raster);
  // none of these reads what another one writes
  pool.run(5, [&](int task) {
    if (task < 3) return fluid::list_shut_faces(solver.fine(), task, shut[task]);
    if (task == 3) return solver.rebuild();
    push_swept(raster);
    mark_fluid_cells(raster);
  });
}

void Fluid::State::push_swept(const HandRaster& raster) {
  const CellBox& box = raster.box;
  for (int k = box.lower[2]; k < box.upper[2]; ++k) {
    for (int j = box.lower[1]; j < box.upper[1]; ++j) {
      const std::size_t row = grid.cell_index(0, j, k);
      fluid::for_bytes(raster.swept.data() + row, box.lower[0], box.upper[0], 1, [&](int i) {
        const std::size_t cell = row + static_cast<std::size_t>(i);
        const Index c = padded.index(i, j, k);
        if (obstacle.closed(c)) return;
        for (int axis = 0; axis < 3; ++axis) {
          velocity[axis][c + padded.stride(axis)] = raster.velocity[axis][cell];
          if (axis != 2 || k > 0) velocity[axis][c] = raster.velocity[axis][cell];
        }
      });
    }
  }
}

void Fluid::State::mark_fluid_cells(const HandRaster& raster) {
  const auto row_of = [&](int j, int k) { return fluid_cells.data() + grid.cell_index(0, j, k); };
  for (int k = marked.lower[2]; k < marked.upper[2]; ++k) {
    for (int j = marked.lower[1]; j < marked.upper[1]; ++j) {
      std::fill(row_of(j, k) + marked.lower[0], row_of(j, k) + marked.upper[0], std::uint8_t{1});
    }
  }
  marked = raster.box;
  for (int k = marked.lower[2]; k < marked.upper[2]; ++k) {
    for (int j = marked.lower[1]; j < marked.upper[1]; ++j) {
      const fluid::RowSpan span = solver.fine().span(j, k);
      const int first = std::max<int>(marked.lower[0], span.begin),
                last = std::min<int>(marked.upper[0], span.end);
      for (int i = first; i < last; ++i) {
        const Index c = padded.index(i, j, k);
        row_of(j, k)[i] = fluid::is_in_hand(raster, i, j, k) || obstacle.closed(c) ? 0 : 1;
        if (obstacle.closed(c)) smoke[c] = 0.0F;
      }
    }
  }
}

/// Pressure whose gradient at the end of a path changes the velocity by 1 m/s from cell to cell:
/// ρh/dt where none acts early [Pa s/m].
double Fluid::State::pressure_per_velocity() const {
  return settings.density * grid.cell / (dt * (1.0 - early));
}

void Fluid::State::solve() {
  const fluid::PressureLevel& level = solver.fine();
  const auto scale = static_cast<float>(-pressure_per_velocity());
  over_planes([&](int k0, int k1) {
    for (int k = k0; k < k1; ++k) {
      sums[static_cast<std::size_t>(k)].divergence =
          fluid::divergence(level, obstacle, velocity, k, scale, solver.right_side().data());
    }
  });
  divergence_before = 0.0;
  for (const PlaneSums& sum : sums) divergence_before += sum.divergence.squares;

  switch (settings.solver) {
    case PressureMethod::Multigrid:
      solver.v_cycles(settings.cycles);
      break;
    case PressureMethod::Mgpcg:
      conjugate_gradients->solve(settings.cg_iterations);
      break;
    case PressureMethod::Jacobi:
      solver.jacobi(settings.jacobi_sweeps, settings.jacobi_warm);
  }
  // the early share is known, so it has no error
  stats.pressure_error = (1.0 - early) * solver.convergence().error();
}

/// Maximum of `largest` over the planes.
std::int32_t Fluid::State::largest_over_planes() const {
  std::int32_t largest = 0;
  for (const PlaneSums& sum : sums) largest = std::max(largest, sum.largest);
  return largest;
}

/// Makes the velocity free of divergence; false if the state is unusable: has NaN, which would trap
/// in later comparisons, or an absurd speed.
bool Fluid::State::project() {
  const auto factor = static_cast<float>(1.0 / pressure_per_velocity());
  over_planes([&](int k0, int k1) {
    for (int k = k0; k < k1; ++k) {
      fluid::subtract_gradient(solver.fine(), obstacle, solver.pressure().data(), factor, velocity,
                               k);
      std::int32_t& largest = sums[static_cast<std::size_t>(k)].largest;
      const Index c = padded.index(0, 0, k);
      largest = 0;
      for (const Field& u : velocity) {
        largest =
            std::max(largest, fluid::largest_bits(u.data() + c, u.data() + c + padded.plane()));
      }
    }
  });
  const std::int32_t largest = largest_over_planes();
  if (largest > std::bit_cast<std::int32_t>(kAbsurd)) return false;
  fastest = static_cast<double>(std::bit_cast<float>(largest));
  stats.max_speed = fastest * dt / grid.cell;
  return true;
}

/// Copies the results for readers; false if a pressure is NaN or absurd.
bool Fluid::State::publish() {
  const int n = padded.n;
  const float late = weight(1.0 - early);
  over_planes([&](int k0, int k1) {
    for (int k = k0; k < k1; ++k) {
      std::int32_t& largest = sums[static_cast<std::size_t>(k)].largest;
      largest = 0;
      for (int j = 0; j < n; ++j) {
        const Index c = padded.index(0, j, k);
        float* const felt = pressure_out.data() + grid.cell_index(0, j, k);
        std::copy_n(solver.pressure().data() + c, n, felt);
        if (is_split()) blend(1.0F, acting.data() + c, late, felt, n);
        largest = std::max(largest, fluid::largest_bits(felt, felt + n));
      }
    }
  });
  constexpr auto kLargest = static_cast<double>(std::numeric_limits<float>::max());
  const double absurd = std::min(static_cast<double>(kAbsurd) * pressure_per_velocity(), kLargest);
  return largest_over_planes() <= std::bit_cast<std::int32_t>(static_cast<float>(absurd));
}

/// Measures the remaining divergence.
void Fluid::State::measure() {
  over_planes([&](int k0, int k1) {
    for (int k = k0; k < k1; ++k) {
      sums[static_cast<std::size_t>(k)].divergence =
          fluid::divergence(solver.fine(), obstacle, velocity, k, 1.0F, nullptr);
    }
  });
  // totals in the order of planes
  double after = 0.0;
  for (const PlaneSums& sum : sums) {
    after += sum.divergence.squares;
    stats.divergence_max = std::max(stats.divergence_max,
                                    static_cast<double>(sum.divergence.largest) * dt / grid.cell);
  }
  stats.divergence_rms = divergence_before > 0.0 ? std::sqrt(after / divergence_before) : 0.0;
}

}  // namespace prostm
