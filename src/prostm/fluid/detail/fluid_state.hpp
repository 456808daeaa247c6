#pragma once
/// The state of a Fluid between steps, and the parts of a step.

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "prostm/fluid/detail/advection.hpp"
#include "prostm/fluid/detail/extrapolation.hpp"
#include "prostm/fluid/detail/obstacle.hpp"
#include "prostm/fluid/detail/pressure/conjugate_gradients.hpp"
#include "prostm/fluid/detail/pressure/pressure_solver.hpp"
#include "prostm/fluid/detail/pressure/projection.hpp"
#include "prostm/fluid/detail/surroundings.hpp"
#include "prostm/fluid/fluid.hpp"

namespace prostm {

struct Fluid::State {
  State(const FluidSettings& settings, const SmokeInflow& inflow, WorkerPool& pool);

  /// Sets everything to rest, without smoke.
  void reset();
  void move_box(const CellShift& by);

  // a step, see Fluid
  void prepare(double step_dt);
  void meet(const HandRaster& raster);
  FluidStats settle();

  // parts of a step, in order
  void advect();
  void add_forces();
  void place_hands(const HandRaster& raster);
  void solve();
  bool publish();
  bool project();
  void measure();

  void finish_substep();
  void extend_into_hands();
  bool is_split() const;
  float weight(double share) const;
  double early_share() const;
  void press_early(int k0, int k1);
  void diffuse();
  void confine_vorticity();
  void push_swept(const HandRaster& raster);
  void mark_fluid_cells(const HandRaster& raster);
  double pressure_per_velocity() const;
  std::int32_t largest_over_planes() const;
  /// Runs f(k0, k1) over all planes.
  template <class F>
  void over_planes(F&& f);

  FluidSettings settings;
  WorkerPool& pool;
  GridShape grid;
  Vec3 home;             // grid.p_DF before the box moved
  CellShift shift = {};  // since then
  fluid::PaddedGrid padded;
  SmokeInflow inflow;  // at the settings' speed
  fluid::Surroundings surroundings;

  // state
  fluid::Field velocity[3];  // at faces [m/s]
  fluid::Field smoke;        // at cells, 0..1; the halo holds smoke that would flow in
  fluid::Obstacle obstacle;
  fluid::PressureSolver solver;
  fluid::Field acting;  // mean pressure over a step that is split; unused else [Pa]
  std::optional<fluid::ConjugateGradients> conjugate_gradients;  // where the settings ask for them

  // the present step
  double dt = 0.0;                 // of a sub-step [s]
  double early = 0.0;              // share of the pressure that acts early
  float keep = 0.0F;               // factor on `acting` before a pressure is added: 0 or 1
  double fastest = 0.0;            // of the last sub-step [m/s]
  bool usable = false;             // false: the state must be reset
  double divergence_before = 0.0;  // Σ of squares, before the projection
  FluidStats stats;

  // scratch
  fluid::Field next_velocity[3], next_smoke;  // the former for cell-centred velocity too
  fluid::Displacements moved;                 // [cells per step]
  fluid::ShutFaces shut[3];
  struct PlaneSums {
    fluid::DivergenceSum divergence;
    std::int32_t largest = 0;  // the bits of the largest |pressure|, then of the largest |velocity|
  };
  std::vector<PlaneSums> sums;  // one per plane, so that totals do not depend on threads
  CellBox marked;               // box in which fluid_cells may be 0
  // height of the lowest hand of the last step above the array [m]
  double lowest_hand = std::numeric_limits<double>::infinity();

  // results for readers, without padding
  std::vector<float> pressure_out;
  std::vector<std::uint8_t> fluid_cells;
};

}  // namespace prostm
