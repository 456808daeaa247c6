#include "prostm/fluid/detail/settings.hpp"

#include <sstream>
#include <stdexcept>

#include "prostm/core/require.hpp"
#include "prostm/fluid/fluid.hpp"

namespace prostm {
namespace {

template <class T>
[[noreturn]] void refuse(const char* name, const T& value, const char* bound) {
  std::ostringstream text;
  text << name << " = " << value << " must be " << bound;
  throw std::invalid_argument(text.str());
}

}  // namespace

void FluidSettings::visit(SettingsVisitor& v) {
  v.field("cells", cells);
  v.field("width", width);
  v.field("solver", solver);
  v.field("cycles", cycles);
  v.field("jacobi_sweeps", jacobi_sweeps);
  v.field("jacobi_warm", jacobi_warm);
  v.field("jet_speed", jet_speed);
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
  require_between("cycles", s.cycles, 1, 100);
  require_between("jacobi_sweeps", s.jacobi_sweeps, 1, 100000);
  require_between("width", s.width, 0.05, 5.0, "m");
  require_between("jet_speed", s.jet_speed, 0.0, 3.0);
  require_between("buoyancy", s.buoyancy, 0.0, 100.0, "m/s²");
  require_between("vorticity", s.vorticity, 0.0, 100.0, "1/s");
  require_between("density", s.density, 0.01, 2000.0, "kg/m³");
  require_between("dissipation", s.dissipation, 0.0, 100.0, "1/s");
}

void validate(const Scene& scene) {
  require_between("vent speed", scene.vent_speed, 0.0, 20.0, "m/s");
  for (const SmokeJet& jet : scene.jets) {
    require_between("jet centre x", jet.centre.x(), -10.0, 10.0, "m");
    require_between("jet centre y", jet.centre.y(), -10.0, 10.0, "m");
    require_between("jet radius", jet.radius, 1e-3, 1.0, "m");
    require_between("jet speed", jet.speed, 0.0, 20.0, "m/s");
  }
}

}  // namespace fluid
}  // namespace prostm
