#include "prostm/fluid/fluid.hpp"

#include <stdexcept>

#include "prostm/fluid/detail/fluid_state.hpp"

namespace prostm {

using fluid::Field;
using fluid::Index;

Fluid::Fluid(const FluidSettings& settings, const SmokeInflow& inflow, WorkerPool& pool)
    : state_(std::make_unique<State>(settings, inflow, pool)) {}
Fluid::~Fluid() = default;

const GridShape& Fluid::grid() const {
  return state_->grid;
}
const FluidSettings& Fluid::settings() const {
  return state_->settings;
}
void Fluid::set_inflow(const SmokeInflow& inflow) {
  fluid::blow(inflow, state_->settings.jet_speed, state_->inflow);
  state_->surroundings.set_inflow(state_->inflow);
  state_->surroundings.set_floor(state_->obstacle.wall_velocity(2));
}
void Fluid::move_box(const CellShift& by) noexcept {
  state_->move_box(by);
}
FluidStats Fluid::step(double dt, const HandRaster& raster) noexcept {
  prepare(dt);
  meet(raster);
  return settle();
}
void Fluid::prepare(double dt) noexcept {
  state_->prepare(dt);
}
void Fluid::meet(const HandRaster& raster) noexcept {
  state_->meet(raster);
}
FluidStats Fluid::settle() noexcept {
  return state_->settle();
}
std::span<const float> Fluid::pressure() const {
  return state_->pressure_out;
}
std::span<const std::uint8_t> Fluid::fluid_cells() const {
  return state_->fluid_cells;
}
std::span<const float> Fluid::smoke_row(int j, int k) const {
  return {state_->smoke.data() + state_->padded.index(0, j, k),
          static_cast<std::size_t>(state_->padded.n)};
}

Vec3 Fluid::velocity(int i, int j, int k) const {
  const Index c = state_->padded.index(i, j, k);
  Vec3 centre;
  for (int axis = 0; axis < 3; ++axis) {
    const Field& u = state_->velocity[axis];
    centre[axis] =
        0.5 * (static_cast<double>(u[c]) + static_cast<double>(u[c + state_->padded.stride(axis)]));
  }
  return centre;
}

double Fluid::divergence(int i, int j, int k) const {
  const Index c = state_->padded.index(i, j, k);
  double outflow = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const Field& u = state_->velocity[axis];
    outflow += static_cast<double>(u[c + state_->padded.stride(axis)]) - static_cast<double>(u[c]);
  }
  return outflow / state_->grid.cell;
}

void Fluid::copy_state(const Fluid& other) {
  State& to = *state_;
  const State& from = *other.state_;
  if (!(to.grid == from.grid))
    throw std::invalid_argument("the other fluid's grid differs: its state cannot be copied");
  for (int axis = 0; axis < 3; ++axis) to.velocity[axis].copy_from(from.velocity[axis]);
  to.smoke.copy_from(from.smoke);
  to.solver.pressure().copy_from(from.solver.pressure());
  to.pressure_out = from.pressure_out;
}

}  // namespace prostm
