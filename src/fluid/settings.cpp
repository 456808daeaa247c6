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

void require(bool good, const char* name, double value, const char* bound) {
  if (!(std::isfinite(value) && good)) refuse(name, value, bound);
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
  require(s.width >= 0.05 && s.width <= 5.0, "width", s.width, "between 0.05 and 5 m");
  require(s.buoyancy >= 0.0 && s.buoyancy <= 100.0, "buoyancy", s.buoyancy,
          "between 0 and 100 m/s²");
  require(s.vorticity >= 0.0 && s.vorticity <= 100.0, "vorticity", s.vorticity,
          "between 0 and 100 1/s");
  require(s.density >= 0.01 && s.density <= 2000.0, "density", s.density,
          "between 0.01 and 2000 kg/m³");
  require(s.dissipation >= 0.0 && s.dissipation <= 100.0, "dissipation", s.dissipation,
          "between 0 and 100 1/s");
}

void validate(const Scene& scene) {
  for (const SmokeJet& jet : scene.jets) {
    require(jet.centre.allFinite(), "jet centre", jet.centre.x(), "finite");
    require(jet.radius > 0.0 && jet.radius <= 1.0, "jet radius", jet.radius,
            "above 0 and at most 1 m");
    require(jet.speed >= 0.0 && jet.speed <= 20.0, "jet speed", jet.speed, "between 0 and 20 m/s");
  }
}

}  // namespace fluid
}  // namespace prostm
