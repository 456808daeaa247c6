#include "prostm/fluid/detail/surroundings.hpp"

#include <algorithm>
#include <cmath>

#include "prostm/fluid/detail/settings.hpp"

namespace prostm::fluid {
namespace {

/// Flat in the middle, smooth at the rim: exp(−(r/R)⁴).
double jet_profile(const SmokeJet& jet, const Vec2& p) {
  const double q = (p - jet.centre).squaredNorm() / (jet.radius * jet.radius);
  return q < 6.0 ? std::exp(-q * q) : 0.0;
}

}  // namespace

Surroundings::Surroundings(const GridShape& grid, const SmokeInflow& inflow)
    : grid_{grid.nx}, vented_(inflow.vent_speed > 0.0) {
  validate(inflow);
  for (int j = 0; j < grid.ny; ++j) {
    for (int i = 0; i < grid.nx; ++i) {
      const Vec2 p = grid.cell_centre(i, j, 0).head<2>();
      double speed = inflow.vent_speed, share = 0.0;
      for (const SmokeJet& jet : inflow.jets) {
        speed += jet.speed * jet_profile(jet, p);
        share = std::max(share, jet_profile(jet, p));
      }
      speed_.push_back(static_cast<float>(speed));
      share_.push_back(static_cast<float>(share));
    }
  }
}

void Surroundings::set_floor(Field& w) const {
  for (int j = 0; j < grid_.n; ++j) {
    std::copy_n(speed_.data() + column(0, j), grid_.n, w.data() + grid_.index(0, j, 0));
  }
}

void Surroundings::set_smoke_halo(Field& smoke) const {
  for (int j = 0; j < grid_.n; ++j) {
    const float* share = share_.data() + column(0, j);
    const float* first = smoke.data() + grid_.index(0, j, 0);
    float* below = smoke.data() + grid_.index(0, j, -1);
    for (int i = 0; i < grid_.n; ++i) {
      const float beside = vented_ ? 0.0F : first[i];
      below[i] = share[i] + (1.0F - share[i]) * beside;
    }
  }
}

void Surroundings::calm_inflow(Field velocity[3]) const {
  const int last = grid_.n - 1;
  for (int axis = 0; axis < 3; ++axis) {
    const int other[2] = {(axis + 1) % 3, (axis + 2) % 3};
    for (int side = axis == 2 ? 1 : 0; side < 2; ++side) {  // the floor is not open
      for (int b = 0; b <= last; ++b) {
        for (int a = 0; a <= last; ++a) {
          int at[3];
          at[axis] = side * last;
          at[other[0]] = a;
          at[other[1]] = b;
          const Index c = grid_.index(at[0], at[1], at[2]);
          float& inward = velocity[axis][c + side * grid_.stride(axis)];
          if (side == 0 ? inward <= 0.0F : inward >= 0.0F) continue;
          inward = 0.0F;
          for (const int t : other) {
            if (t != 2 || at[2] > 0) velocity[t][c] = 0.0F;
            velocity[t][c + grid_.stride(t)] = 0.0F;
          }
        }
      }
    }
  }
}

}  // namespace prostm::fluid
