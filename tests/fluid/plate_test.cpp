/// The force of a jet on a plate against the momentum that it brings.

#include <gtest/gtest.h>

#include "analytic_raster.hpp"
#include "prostm/fluid/fluid.hpp"

namespace prostm {
namespace {

constexpr double kPlate = 0.20;   // height of the plate's lower side [m]
constexpr double kBefore = 0.15;  // height at which the jet is still free [m]

/// Calls use(i, j) for each column.
template <class Use>
void over_columns(const GridShape& grid, const Use& use) {
  for (int j = 0; j < grid.ny; ++j) {
    for (int i = 0; i < grid.nx; ++i) use(i, j);
  }
}

/// ∫ ρ w² + p over the level plane through the cells at a height [N].
double momentum_flux(const Fluid& fluid, double height) {
  const GridShape& g = fluid.grid();
  const int k = static_cast<int>(height / g.cell);
  double sum = 0.0;
  over_columns(g, [&](int i, int j) {
    const double w = fluid.velocity(i, j, k).z();
    sum += fluid.settings().density * w * w +
           static_cast<double>(fluid.pressure()[g.cell_index(i, j, k)]);
  });
  return sum * g.cell * g.cell;
}

/// ∫ p over the plate, of the cells that its lower side cuts [N].
double force_on_plate(const Fluid& fluid) {
  const GridShape& g = fluid.grid();
  const int k = static_cast<int>(kPlate / g.cell);
  double sum = 0.0;
  over_columns(g, [&](int i, int j) {
    sum += static_cast<double>(fluid.pressure()[g.cell_index(i, j, k)]);
  });
  return sum * g.cell * g.cell;
}

struct Jet {
  int cells;
  double radius;  // [m]
};

// the radius of a jet must be five cells or more
TEST(Plate, FeelsTheMomentumOfAJet) {
  for (const Jet& jet : {Jet{48, 0.035}, Jet{64, 0.028}, Jet{80, 0.023}}) {
    WorkerPool pool(2);
    FluidSettings settings;
    settings.cells = jet.cells;
    Fluid fluid(settings, {{{Vec2(0.004, -0.007), jet.radius, 0.6}}, 0.0, 0.95e-4}, pool);
    const HandRaster plate =  // as wide as the box
        test::shape_raster(fluid.grid(), [](const Vec3& p) {
          return test::rounded_box(p, Vec3(0, 0, kPlate + 0.01), Vec3(0.25, 0.25, 0.01), 0.001);
        });
    double force = 0.0, flux = 0.0;
    constexpr int kSettle = 150, kSteps = 40;
    for (int t = 0; t < kSettle + kSteps; ++t) {
      fluid.step(0.02, plate);
      if (t < kSettle) continue;
      force += force_on_plate(fluid);
      flux += momentum_flux(fluid, kBefore);
    }
    EXPECT_NEAR(force, flux, 0.05 * flux) << jet.cells << "³, " << jet.radius;
    EXPECT_GT(flux, 0.1e-3 * kSteps);
  }
}

}  // namespace
}  // namespace prostm
