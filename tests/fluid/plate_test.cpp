/// The force of a jet on a plate, compared with the jet's momentum flux.

#include <gtest/gtest.h>

#include <algorithm>

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

/// ∫ ρ w² + p over the horizontal plane through the cells at a height [N].
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

/// ∫ ρ w u_n over the box's sides from kBefore to the plate, u_n outwards where air leaves; air
/// that enters was at rest [N].
double momentum_out(const Fluid& fluid) {
  const GridShape& g = fluid.grid();
  const int last = g.nx - 1;
  double sum = 0.0;
  for (int k = static_cast<int>(kBefore / g.cell); k < static_cast<int>(kPlate / g.cell); ++k) {
    for (int a = 0; a <= last; ++a) {
      const auto add = [&](const Vec3& u, double out) { sum += std::max(out, 0.0) * u.z(); };
      const Vec3 left = fluid.velocity(0, a, k), right = fluid.velocity(last, a, k),
                 near = fluid.velocity(a, 0, k), far = fluid.velocity(a, last, k);
      add(left, -left.x());
      add(right, right.x());
      add(near, -near.y());
      add(far, far.y());
    }
  }
  return fluid.settings().density * sum * g.cell * g.cell;
}

/// ∫ p over the plate, from the cells that its lower side cuts [N].
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

TEST(Plate, ReceivesTheMomentumOfAJet) {
  for (const double theta : {1.0, 0.6}) {
    for (const Jet& jet : {Jet{48, 0.035}, Jet{64, 0.028}, Jet{80, 0.023}, Jet{64, 0.020}}) {
      WorkerPool pool(2);
      FluidSettings settings;
      settings.cells = jet.cells;
      settings.theta = theta;
      Fluid fluid(settings, {{{Vec2(0.004, -0.007), jet.radius, 0.6}}, 0.06, 0.95e-4}, pool);
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
        flux += momentum_flux(fluid, kBefore) - momentum_out(fluid);
      }
      EXPECT_NEAR(force, flux, 0.02 * flux) << theta << ", " << jet.cells << "³, " << jet.radius;
      EXPECT_GT(flux, 0.5e-3 * kSteps);
    }
  }
}

}  // namespace
}  // namespace prostm
