#include "fluid/settings.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "fluid/fluid.hpp"

namespace prostm {
namespace {

template <class T>
[[noreturn]] void refuse(const char* name, const T& value, const char* bound) {
  std::ostringstream text;
  text << name << " = " << value << " must be " << bound;
  throw std::invalid_argument(text.str());
}

/// NaN is refused before it is compared: the comparison would trap.
void require(const char* name, double value, double low, double high, const char* bound) {
  if (!std::isfinite(value) || value < low || value > high) refuse(name, value, bound);
}

}  // namespace

void FluidSettings::visit(SettingsVisitor& v) {
  v.field("cells", cells);
  v.field("width", width);
  v.field("solver", solver);
  v.field("cycles", cycles);
  v.field("jacobi_sweeps", jacobi_sweeps);
  v.field("jacobi_warm", jacobi_warm);
  v.field("buoyancy", buoyancy);
  v.field("vorticity", vorticity);
  v.field("density", density);
  v.field("dissipation", dissipation);
}

namespace fluid {

void validate(const FluidSettings& s) {
  if (s.cells < 32 || s.cells > 128 || s.cells % 16 != 0) {
    refuse("cells", s.cells, "a multiple of 16 between 32 and 128");
  }
  if (s.solver != "multigrid" && s.solver != "jacobi")
    refuse("solver", s.solver, "multigrid or jacobi");
  if (s.cycles < 1 || s.cycles > 100) refuse("cycles", s.cycles, "between 1 and 100");
  if (s.jacobi_sweeps < 1 || s.jacobi_sweeps > 100000)
    refuse("jacobi_sweeps", s.jacobi_sweeps, "between 1 and 100000");
  require("width", s.width, 0.05, 5.0, "between 0.05 and 5 m");
  require("buoyancy", s.buoyancy, 0.0, 100.0, "between 0 and 100 m/s²");
  require("vorticity", s.vorticity, 0.0, 100.0, "between 0 and 100 1/s");
  require("density", s.density, 0.01, 2000.0, "between 0.01 and 2000 kg/m³");
  require("dissipation", s.dissipation, 0.0, 100.0, "between 0 and 100 1/s");
}

void validate(const Scene& scene) {
  require("vent speed", scene.vent_speed, 0.0, 20.0, "between 0 and 20 m/s");
  for (const SmokeJet& jet : scene.jets) {
    require("jet centre x", jet.centre.x(), -10.0, 10.0, "between -10 and 10 m");
    require("jet centre y", jet.centre.y(), -10.0, 10.0, "between -10 and 10 m");
    require("jet radius", jet.radius, 1e-3, 1.0, "between 0.001 and 1 m");
    require("jet speed", jet.speed, 0.0, 20.0, "between 0 and 20 m/s");
  }
}

}  // namespace fluid
}  // namespace prostm
