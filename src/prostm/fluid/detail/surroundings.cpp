#include "prostm/fluid/detail/surroundings.hpp"

#include <algorithm>
#include <cmath>

#include "prostm/fluid/detail/over_planes.hpp"
#include "prostm/fluid/detail/settings.hpp"

namespace prostm::fluid {
namespace {

/// Flat in the middle, smooth at the rim: exp(−(r/R)⁴).
double jet_profile(const SmokeJet& jet, const Vec2& p) {
  const double q = (p - jet.centre).squaredNorm() / (jet.radius * jet.radius);
  return q < 6.0 ? std::exp(-q * q) : 0.0;
}

}  // namespace

void blow(const SmokeInflow& inflow, double factor, SmokeInflow& to) {
  to = inflow;
  for (SmokeJet& jet : to.jets) jet.speed *= factor;
  to.vent_speed *= factor;
  to.viscosity *= factor;
  if (factor > 0.0) to.guide_time /= factor;
  if (factor == 0.0) to.guide_height = 0.0;
}

SmokeInflow blown(const SmokeInflow& inflow, double factor) {
  SmokeInflow out;
  blow(inflow, factor, out);
  return out;
}

Surroundings::Surroundings(const GridShape& grid, const SmokeInflow& inflow)
    : grid_{grid.nx},
      shape_(grid),
      speed_(static_cast<std::size_t>(grid.nx) * static_cast<std::size_t>(grid.ny)),
      share_(speed_.size()),
      smoky_(static_cast<std::size_t>(grid.ny)) {
  validate(inflow);
  set_inflow(inflow);
}

void Surroundings::set_inflow(const SmokeInflow& inflow) {
  vented_ = inflow.vent_speed > 0.0;
  guide_height_ = inflow.guide_height;
  guide_time_ = inflow.guide_time;
  for (int j = 0; j < shape_.ny; ++j) {
    RowSpan& smoky = smoky_[static_cast<std::size_t>(j)];
    smoky = {};
    for (int i = 0; i < shape_.nx; ++i) {
      const Vec2 p = shape_.cell_centre(i, j, 0).head<2>();
      double speed = inflow.vent_speed, share = 0.0;
      for (const SmokeJet& jet : inflow.jets) {
        const double profile = jet_profile(jet, p);
        speed += jet.speed * profile;
        share = std::max(share, profile);
      }
      speed_[column(i, j)] = static_cast<float>(speed);
      share_[column(i, j)] = static_cast<float>(share);
      if (share == 0.0) continue;
      if (smoky.empty()) smoky.begin = static_cast<std::int16_t>(i);
      smoky.end = static_cast<std::int16_t>(i + 1);
    }
  }
}

void Surroundings::place(const GridShape& grid, const SmokeInflow& inflow) {
  shape_ = grid;
  set_inflow(inflow);
}

void Surroundings::guide(WorkerPool& pool, double dt, double ceiling, Field velocity[3]) const {
  const double height = std::min(guide_height_, ceiling) - shape_.p_DF.z();
  if (height <= 0.0) return;
  const auto hold = static_cast<float>(1.0 - std::exp(-dt / guide_time_));
  // faces of w are at k h, those of u and v at (k + ½) h
  const auto below = [&](double z) {
    return std::clamp(static_cast<int>(std::ceil(z / shape_.cell)), 0, grid_.n);
  };
  const int vertical = below(height), sideways = below(height - 0.5 * shape_.cell);
  over_planes(pool, vertical, [&](int k0, int k1) {
    for (int k = k0; k < k1; ++k) guide_plane(k, k < sideways, hold, velocity);
  });
}

void Surroundings::guide_plane(int k, bool sideways, float hold, Field velocity[3]) const {
  for (int j = 0; j < grid_.n; ++j) {
    const auto [begin, end] = smoky_[static_cast<std::size_t>(j)];
    const Index c = grid_.index(0, j, k);
    const float *share = share_.data() + column(0, j), *speed = speed_.data() + column(0, j);
    float* const w = velocity[2].data() + c;
    for (int i = begin; i < end && k > 0; ++i) w[i] += hold * share[i] * (speed[i] - w[i]);
    // a face between two columns takes half of the pull from each
    for (int axis = 0; axis < 2 && sideways; ++axis) {
      float* const low = velocity[axis].data() + c;
      float* const high = low + grid_.stride(axis);
      for (int i = begin; i < end; ++i) low[i] *= 1.0F - 0.5F * hold * share[i];
      for (int i = begin; i < end; ++i) high[i] *= 1.0F - 0.5F * hold * share[i];
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

void Surroundings::calm_inflow(WorkerPool& pool, Field velocity[3]) const {
  // the two sides of an axis have no cell in common; the floor is not open
  pool.run(2, [&](int side) { calm_side(0, side, velocity); });
  pool.run(2, [&](int side) { calm_side(1, side, velocity); });
  calm_side(2, 1, velocity);
}

void Surroundings::calm_side(int axis, int side, Field velocity[3]) const {
  const int last = grid_.n - 1, other[2] = {(axis + 1) % 3, (axis + 2) % 3};
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

}  // namespace prostm::fluid
