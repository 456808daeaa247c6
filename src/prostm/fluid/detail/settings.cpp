#include "prostm/fluid/detail/settings.hpp"

#include "prostm/core/require.hpp"
#include "prostm/fluid/fluid.hpp"

namespace prostm {
namespace {

template <class Settings, class Visitor>
void list(Settings& s, Visitor& v) {
  v.field({"cells", "", FluidSettings::kLeastCells, FluidSettings::kMostCells,
           "cells along each edge of the box"},
          s.cells);
  v.field({"width", "m", 0.05, 5,
           "edge of the box, which stands on the array unless [box] follow moves it"},
          s.width);
  v.field({"substeps", "", 1, 16, "fluid steps per world step"}, s.substeps);
  v.field({"theta", "", 0.6, 1, "weight of the pressure at the end of a path; 1: implicit"},
          s.theta);
  v.field({.name = "solver", .help = "solver of the pressure"}, s.solver);
  v.field({"cycles", "", 1, 100, "V-cycles a step"}, s.cycles);
  v.field({"cg_iterations", "", 1, 100, "iterations a step of mgpcg"}, s.cg_iterations);
  v.field({"jacobi_sweeps", "", 1, 100'000, "sweeps a step of the paper's solver"},
          s.jacobi_sweeps);
  v.field({.name = "jacobi_warm", .help = "whether sweeps start from the last pressure"},
          s.jacobi_warm);
  v.field({"jet_speed", "", 0, 3, "factor on the speed of the scene's flow"}, s.jet_speed);
  v.field({.name = "hand", .help = "how hands cut the grid: fractions of faces, or whole voxels"},
          s.hand);
  v.field({"buoyancy", "m/s²", 0, 100, "upward acceleration of undiluted smoke"}, s.buoyancy);
  v.field({"vorticity", "1/s", 0, 100, "strength of vorticity confinement; 0: none"}, s.vorticity);
  v.field({"density", "kg/m³", 0.01, 2000, "density of the air"}, s.density);
  v.field({"dissipation", "1/s", 0, 100, "decay rate of the smoke's density"}, s.dissipation);
}

}  // namespace

void FluidSettings::visit(SettingsReader& v) const {
  list(*this, v);
}
void FluidSettings::visit(SettingsWriter& v) {
  list(*this, v);
}

namespace fluid {

void validate(const FluidSettings& s) {
  require_bounds(s);
}

void validate(const SmokeInflow& inflow) {
  require_between("vent speed", inflow.vent_speed, 0.0, 20.0, "m/s");
  require_between("viscosity", inflow.viscosity, 0.0, 0.01, "m²/s");
  require_between("guide height", inflow.guide_height, 0.0, 5.0, "m");
  require_between("guide time", inflow.guide_time, 1e-3, 1e3, "s");
  for (const SmokeJet& jet : inflow.jets) {
    require_between("jet centre x", jet.centre.x(), -10.0, 10.0, "m");
    require_between("jet centre y", jet.centre.y(), -10.0, 10.0, "m");
    require_between("jet radius", jet.radius, 1e-3, 1.0, "m");
    require_between("jet speed", jet.speed, 0.0, 20.0, "m/s");
  }
}

}  // namespace fluid
}  // namespace prostm
