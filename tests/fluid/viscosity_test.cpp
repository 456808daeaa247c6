#include "prostm/fluid/detail/viscosity.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"

namespace prostm::fluid {
namespace {

/// Number of faces of an axis along each dimension.
struct Faces {
  Faces(const PaddedGrid& grid, int along) : axis(along) {
    for (int a = 0; a < 3; ++a) count[a] = grid.n + (a == along ? 1 : 0);
  }
  int axis;
  int count[3];
};

template <class F>
void for_faces(const Faces& faces, F&& f) {
  for (int k = 0; k < faces.count[2]; ++k) {
    for (int j = 0; j < faces.count[1]; ++j) {
      for (int i = 0; i < faces.count[0]; ++i) f(i, j, k);
    }
  }
}

void diffuse_all(const PaddedGrid& grid, int axis, const Field& u, float share, Field& out) {
  for (int k = 0; k < Faces(grid, axis).count[2]; ++k) diffuse(grid, axis, u, share, out, k);
}

/// The same in plain code: a face outside repeats the one at the side.
double reference(const PaddedGrid& grid, const Faces& faces, const Field& u, double share, int i,
                 int j, int k) {
  const auto at = [&](int a, int b, int c) {
    return static_cast<double>(
        u[grid.index(std::clamp(a, 0, faces.count[0] - 1), std::clamp(b, 0, faces.count[1] - 1),
                     std::clamp(c, 0, faces.count[2] - 1))]);
  };
  const double own = at(i, j, k);
  if (faces.axis == 2 && k == 0) return own;
  return own + share * (at(i - 1, j, k) + at(i + 1, j, k) + at(i, j - 1, k) + at(i, j + 1, k) +
                        at(i, j, k - 1) + at(i, j, k + 1) - 6.0 * own);
}

constexpr float kShare = 0.12F;

TEST(Viscosity, MatchesPlainCodeOnEveryFace) {
  Random random(11);
  for (const int n : {32, 48}) {
    const PaddedGrid grid{n};
    for (int axis = 0; axis < 3; ++axis) {
      const Faces faces(grid, axis);
      Field u(grid), out(grid);
      for_faces(faces, [&](int i, int j, int k) {
        u[grid.index(i, j, k)] = static_cast<float>(random.uniform(-2.0, 2.0));
      });
      diffuse_all(grid, axis, u, kShare, out);
      double worst = 0.0;
      for_faces(faces, [&](int i, int j, int k) {
        const double expected = reference(grid, faces, u, static_cast<double>(kShare), i, j, k);
        worst = std::max(worst, std::abs(static_cast<double>(out[grid.index(i, j, k)]) - expected));
      });
      EXPECT_LT(worst, 2e-6) << n << " cells, axis " << axis;
    }
  }
}

// u = cos(m π (j + ½) / n) between walls that repeat the value: each pass multiplies it by
// 1 − 2 share (1 − cos(m π / n))
TEST(Viscosity, DampsAWaveAsItsClosedForm) {
  const PaddedGrid grid{32};
  const auto wave = [&](int j, int m) { return std::cos(m * kPi * (j + 0.5) / grid.n); };
  for (const int m : {1, 3, 9}) {
    Field u(grid), out(grid);
    const Faces faces(grid, 0);
    for_faces(faces, [&](int i, int j, int k) {
      u[grid.index(i, j, k)] = static_cast<float>(wave(j, m));
    });
    const double share = 0.15;
    for (int pass = 0; pass < 20; ++pass) {
      diffuse_all(grid, 0, u, static_cast<float>(share), out);
      std::swap(u, out);
    }
    const double factor = std::pow(1.0 - 2.0 * share * (1.0 - std::cos(m * kPi / grid.n)), 20);
    for_faces(faces, [&](int i, int j, int k) {
      ASSERT_NEAR(u[grid.index(i, j, k)], factor * wave(j, m), 2e-6);
    });
  }
}

TEST(Viscosity, UsesAsManyPassesAsStabilityNeeds) {
  EXPECT_EQ(viscous_passes(0.0), 0);
  EXPECT_EQ(viscous_passes(0.1), 1);
  EXPECT_EQ(viscous_passes(0.15), 1);
  EXPECT_EQ(viscous_passes(0.16), 2);
  EXPECT_EQ(viscous_passes(1.5), 10);
}

}  // namespace
}  // namespace prostm::fluid
