#pragma once
/// The surroundings of the box: a floor with jets and perhaps a vent, and five open sides.

#include <vector>

#include "prostm/core/worker_pool.hpp"
#include "prostm/fluid/detail/padded_grid.hpp"
#include "prostm/fluid/detail/pressure/pressure_level.hpp"
#include "prostm/fluid/fluid.hpp"
#include "prostm/hand/hand_raster.hpp"

namespace prostm::fluid {

/// Sets `to` to an inflow at `factor` times its speed. Everything with a speed is scaled, so that
/// the flow stays similar: lengths are unchanged, and times shrink by the factor.
void blow(const SmokeInflow& inflow, double factor, SmokeInflow& to);
SmokeInflow blown(const SmokeInflow& inflow, double factor);

/// Boundary conditions of the box. The values that it sets in the fluid's fields hold for one step.
class Surroundings {
 public:
  /// @throws std::invalid_argument for an inflow out of bounds.
  Surroundings(const GridShape& grid, const SmokeInflow& inflow);

  /// Replaces the inflow.
  void set_inflow(const SmokeInflow& inflow);

  /// Adapts to a box at another place.
  void place(const GridShape& grid, const SmokeInflow& inflow);

  /// Holds the jets in the tube of (F14) for a step of dt [s], up to the height `ceiling` above the
  /// array at most [m].
  void guide(WorkerPool& pool, double dt, double ceiling, Field velocity[3]) const;

  /// Sets the velocity of the floor's faces.
  void set_floor(Field& w) const;
  /// Sets the smoke that would flow in with the next step: fresh smoke through a jet, clean air
  /// beside it through a vented floor; a solid floor repeats the smoke just above it. Beyond the
  /// open sides is clear air, which the halo holds from the start.
  void set_smoke_halo(Field& smoke) const;
  /// Removes the momentum of the cells at an open side where the flow is inward, since air that
  /// enters was at rest outside (F3a); the projection alone drives it. Otherwise the momentum would
  /// amplify itself and set the whole box rotating.
  void calm_inflow(WorkerPool& pool, Field velocity[3]) const;

 private:
  void guide_plane(int k, bool sideways, float hold, Field velocity[3]) const;
  void calm_side(int axis, int side, Field velocity[3]) const;
  std::size_t column(int i, int j) const { return static_cast<std::size_t>(j * grid_.n + i); }

  PaddedGrid grid_;
  GridShape shape_;
  bool vented_ = false;                       // clean air comes through the floor
  double guide_height_ = 0, guide_time_ = 0;  // [m], [s]
  std::vector<float> speed_;                  // inflow speed at the floor's faces [m/s], n·n
  std::vector<float> share_;                  // share of fresh smoke in it, 0..1
  std::vector<RowSpan> smoky_;                // of each row of cells, those with fresh smoke
};

}  // namespace prostm::fluid
