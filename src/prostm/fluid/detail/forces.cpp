#include "prostm/fluid/detail/forces.hpp"

#include <cmath>

// plain loops, compiled for each vector width
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prostm/fluid/detail/forces.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace prostm::fluid {
namespace HWY_NAMESPACE {
namespace {

/// ∇×u by centred differences, cell edge 1.
HWY_INLINE void curl(const PaddedGrid& grid, const Field u[3], Index c, float omega[3]) {
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3, d = (a + 2) % 3;
    const Index sb = grid.stride(b), sd = grid.stride(d);
    omega[a] = 0.5F * ((u[d][c + sb] - u[d][c - sb]) - (u[b][c + sd] - u[b][c - sd]));
  }
}

void AddBuoyancy(const PaddedGrid& grid, const Field& smoke, float dt_beta, Field& w, int k) {
  const Index plane = grid.plane();
  for (int j = 0; j < grid.n; ++j) {
    const Index c = grid.index(0, j, k);
    const float* s = smoke.data() + c;
    float* to = w.data() + c;
    for (int i = 0; i < grid.n && k > 0; ++i) to[i] += dt_beta * 0.5F * (s[i - plane] + s[i]);
    for (int i = 0; i < grid.n && k == grid.n - 1; ++i) to[i + plane] += dt_beta * s[i];
  }
}

void CentreVelocity(const PaddedGrid& grid, const Field velocity[3], float scale, Field centre[3],
                    int k) {
  const float half = 0.5F * scale;
  for (int a = 0; a < 3; ++a) {
    const Index s = grid.stride(a);
    for (int j = 0; j < grid.n; ++j) {
      const float* u = velocity[a].data() + grid.index(0, j, k);
      float* to = centre[a].data() + grid.index(0, j, k);
      for (int i = 0; i < grid.n; ++i) to[i] = half * (u[i] + u[i + s]);
    }
  }
}

void VorticityMagnitude(const PaddedGrid& grid, const Field centre[3], Field& magnitude, int k) {
  for (int j = 0; j < grid.n; ++j) {
    for (int i = 0; i < grid.n; ++i) {
      float omega[3];
      curl(grid, centre, grid.index(i, j, k), omega);
      magnitude[grid.index(i, j, k)] =
          std::sqrt(omega[0] * omega[0] + omega[1] * omega[1] + omega[2] * omega[2]);
    }
  }
}

void ConfinementForce(const PaddedGrid& grid, const Field centre[3], const Field& magnitude,
                      float epsilon, Field force[3], int k) {
  constexpr float kLeastGradient = 1e-6F;  // below this there is no direction to push in
  for (int j = 0; j < grid.n; ++j) {
    for (int i = 0; i < grid.n; ++i) {
      const Index c = grid.index(i, j, k);
      float omega[3], gradient[3];
      curl(grid, centre, c, omega);
      for (int a = 0; a < 3; ++a)
        gradient[a] = 0.5F * (magnitude[c + grid.stride(a)] - magnitude[c - grid.stride(a)]);
      const float length = std::sqrt(gradient[0] * gradient[0] + gradient[1] * gradient[1] +
                                     gradient[2] * gradient[2]);
      const float scale = length > kLeastGradient ? epsilon / length : 0.0F;
      for (int a = 0; a < 3; ++a) {
        const int b = (a + 1) % 3, d = (a + 2) % 3;
        force[a][c] = scale * (gradient[b] * omega[d] - gradient[d] * omega[b]);
      }
    }
  }
}

void AddCentredForce(const PaddedGrid& grid, const Field force[3], float dt, Field velocity[3],
                     int k) {
  for (int a = 0; a < 3; ++a) {
    const Index s = grid.stride(a);
    for (int j = 0; j < grid.n; ++j) {
      if ((a == 1 && j == 0) || (a == 2 && k == 0)) continue;
      const Index c = grid.index(0, j, k);
      const float* f = force[a].data() + c;
      float* u = velocity[a].data() + c;
      for (int i = a == 0 ? 1 : 0; i < grid.n; ++i) u[i] += dt * 0.5F * (f[i - s] + f[i]);
    }
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace prostm::fluid
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace prostm::fluid {
namespace {

HWY_EXPORT(AddBuoyancy);
HWY_EXPORT(CentreVelocity);
HWY_EXPORT(VorticityMagnitude);
HWY_EXPORT(ConfinementForce);
HWY_EXPORT(AddCentredForce);

}  // namespace

void add_buoyancy(const PaddedGrid& grid, const Field& smoke, float dt_beta, Field& w, int k) {
  HWY_DYNAMIC_DISPATCH(AddBuoyancy)(grid, smoke, dt_beta, w, k);
}

void centre_velocity(const PaddedGrid& grid, const Field velocity[3], float scale, Field centre[3],
                     int k) {
  HWY_DYNAMIC_DISPATCH(CentreVelocity)(grid, velocity, scale, centre, k);
}

void vorticity_magnitude(const PaddedGrid& grid, const Field centre[3], Field& magnitude, int k) {
  HWY_DYNAMIC_DISPATCH(VorticityMagnitude)(grid, centre, magnitude, k);
}

void confinement_force(const PaddedGrid& grid, const Field centre[3], const Field& magnitude,
                       float epsilon, Field force[3], int k) {
  HWY_DYNAMIC_DISPATCH(ConfinementForce)(grid, centre, magnitude, epsilon, force, k);
}

void add_centred_force(const PaddedGrid& grid, const Field force[3], float dt, Field velocity[3],
                       int k) {
  HWY_DYNAMIC_DISPATCH(AddCentredForce)(grid, force, dt, velocity, k);
}

}  // namespace prostm::fluid
#endif  // HWY_ONCE
