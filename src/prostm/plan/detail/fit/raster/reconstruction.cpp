#include "prostm/plan/detail/fit/raster/reconstruction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace prostm::planning {
namespace {

constexpr int kSweeps = 8;  // each reduces the error of the pressures by a factor of about 4

struct Closest {
  float distance2 = std::numeric_limits<float>::max();
  float along = 0.0F, dx = 0.0F, dy = 0.0F;
  std::int32_t segment = 0;
};

std::size_t next_node(const Loops& loops, std::size_t node) {
  const std::size_t next = node + static_cast<std::size_t>(loops.lanes);
  return next < loops.nodes() ? next : next - loops.nodes();
}

Closest closest_segment(const Loops& loops, float x, float y) {
  Closest best;
  for (int i = 0; i < loops.samples; ++i) {
    for (int k = 0; k < loops.paths; ++k) {
      const std::size_t a = loops.node(i, k), b = next_node(loops, a);
      const float ex = loops.x[b] - loops.x[a], ey = loops.y[b] - loops.y[a];
      const float rx = x - loops.x[a], ry = y - loops.y[a];
      const float squared = std::max(ex * ex + ey * ey, 1e-12F);
      const float t = std::clamp((rx * ex + ry * ey) / squared, 0.0F, 1.0F);
      const float dx = rx - t * ex, dy = ry - t * ey;
      const float distance2 = dx * dx + dy * dy;
      if (distance2 < best.distance2) best = {distance2, t, dx, dy, static_cast<std::int32_t>(a)};
    }
  }
  return best;
}

/// Finds the closest points, and accumulates the normal equations.
void fit_cells(const CellTiles& cells, const Loops& loops, float sigma,
               ReconstructionScratch& scratch) {
  const float falloff = -0.5F / (sigma * sigma);
  for (std::size_t tile = 0; tile < cells.tiles().size(); ++tile) {
    const CellTile& cell = cells.tiles()[tile];
    ReconstructionScratch::TileFit& fit = scratch.fits[tile];
    for (std::size_t c = 0; c < 8; ++c) {
      const Closest close = closest_segment(loops, cell.x[c], cell.y[c]);
      const float exponent = falloff * close.distance2;
      const float phi = exponent >= kLeastExponent ? std::exp(exponent) : 0.0F;
      fit.phi[c] = phi;
      fit.along[c] = close.along;
      fit.dx[c] = close.dx;
      fit.dy[c] = close.dy;
      fit.segment[c] = close.segment;
      const auto s = static_cast<std::size_t>(close.segment);
      const float u = phi * (1.0F - close.along), v = phi * close.along, w = cell.weight[c];
      scratch.normal[4 * s] += w * u * u;
      scratch.normal[4 * s + 1] += w * u * v;
      scratch.normal[4 * s + 2] += w * v * v;
      scratch.normal[4 * s + 3] += w * u * cell.pressure[c];
      scratch.normal_end[s] += w * v * cell.pressure[c];
    }
  }
}

/// Returns the error at the solved pressures, and adds its gradient by segment.
float pull_segments(const CellTiles& cells, const Loops& loops,
                    const ReconstructionSettings& settings, ReconstructionScratch& scratch,
                    const Reconstruction& out) {
  double error = 0.0;
  const float falloff = 1.0F / (settings.sigma * settings.sigma);
  for (std::size_t tile = 0; tile < cells.tiles().size(); ++tile) {
    const CellTile& cell = cells.tiles()[tile];
    const ReconstructionScratch::TileFit& fit = scratch.fits[tile];
    for (std::size_t c = 0; c < 8; ++c) {
      const auto a = static_cast<std::size_t>(fit.segment[c]), b = next_node(loops, a);
      const float t = fit.along[c], change = out.pressure[b] - out.pressure[a];
      const float p = out.pressure[a] + t * change;
      const float residual = fit.phi[c] * p - cell.pressure[c];
      error += static_cast<double>(cell.weight[c] * residual * residual);
      const float common = 2.0F * cell.weight[c] * residual * fit.phi[c];
      // (P12): pressure out of reach of all paths
      const float lack = std::max(1.0F - fit.phi[c] / kReach, 0.0F);
      const float wl = settings.weight_coverage * cell.weight[c] * cell.pressure[c];
      error += static_cast<double>(wl * lack);
      const float k1 = (common * p - (lack > 0.0F ? wl / kReach * fit.phi[c] : 0.0F)) * falloff;
      const float ex = loops.x[b] - loops.x[a], ey = loops.y[b] - loops.y[a];
      const bool inside = t > 0.0F && t < 1.0F;
      const float k2 = inside ? common * change / std::max(ex * ex + ey * ey, 1e-12F) : 0.0F;
      const float at_a = k1 * (1.0F - t) - k2, along_a = -k2 * (1.0F - t);
      const float at_b = k1 * t + k2, along_b = -k2 * t;
      scratch.pull[4 * a] += at_a * fit.dx[c] + along_a * ex;
      scratch.pull[4 * a + 1] += at_a * fit.dy[c] + along_a * ey;
      scratch.pull[4 * a + 2] += at_b * fit.dx[c] + along_b * ex;
      scratch.pull[4 * a + 3] += at_b * fit.dy[c] + along_b * ey;
    }
  }
  return static_cast<float>(error);
}

}  // namespace

ReconstructionScratch::ReconstructionScratch(std::size_t max_tiles) : fits(max_tiles) {}

void ReconstructionScratch::clear(const Loops& loops) {
  std::fill_n(normal.begin(), 4 * loops.nodes(), 0.0F);
  std::fill_n(pull.begin(), 4 * loops.nodes(), 0.0F);
  std::fill_n(normal_end.begin(), loops.nodes(), 0.0F);
}

namespace {

/// Runs the sweeps. The number of lanes is a template parameter, so that a sample's lanes become
/// one vector.
template <std::size_t kLanes>
void sweep(const Loops& loops, const PressureEquations& equations, const NodeArray& inverse,
           const PlayBounds& bounds, NodeArray& pressure) {
  const NodeArray &after = equations.after, &right = equations.right;
  const std::array<float, kMaxPaths>& most = bounds.most;
  const std::size_t n = loops.nodes();
  const auto relax = [&](std::size_t a) {
    const std::size_t b = a + kLanes < n ? a + kLanes : 0;
    const std::size_t before = a > 0 ? a - kLanes : n - kLanes;
    std::array<float, kLanes> p;
    for (std::size_t k = 0; k < kLanes; ++k) {
      p[k] = (right[a + k] - after[a + k] * pressure[b + k] -
              after[before + k] * pressure[before + k]) *
             inverse[a + k];
    }
    for (std::size_t k = 0; k < kLanes; ++k) pressure[a + k] = p[k] < 0.0F ? 0.0F : p[k];
    for (std::size_t k = 0; k < kLanes; ++k) {
      pressure[a + k] = pressure[a + k] < most[k] ? pressure[a + k] : most[k];
    }
  };
  // red-black order if the number of samples is even, so that the updates of a half-sweep are
  // independent
  for (int round = 0; round < kSweeps; ++round) {
    for (std::size_t a = 0; a < n; a += 2 * kLanes) relax(a);
    for (std::size_t a = kLanes; a < n; a += 2 * kLanes) relax(a);
  }
}

}  // namespace

void solve_pressures(const Loops& loops, const ReconstructionSettings& settings,
                     const ReconstructionScratch& scratch, Reconstruction& out) {
  const std::size_t n = loops.nodes(), lanes = static_cast<std::size_t>(loops.lanes);
  const PlayBounds& bounds = settings.bounds;
  PressureEquations equations;
  alignas(64) NodeArray inverse;
  for (std::size_t a = 0, before = n - lanes; a < n; ++a, ++before) {
    if (before == n) before = 0;
    equations.diagonal[a] =
        scratch.normal[4 * a] + scratch.normal[4 * before + 2] + 2.0F * settings.smoothing;
    inverse[a] = 1.0F / equations.diagonal[a];
    equations.after[a] = scratch.normal[4 * a + 1] - settings.smoothing;
    equations.right[a] = scratch.normal[4 * a + 3] + scratch.normal_end[before];
    out.pressure[a] = std::clamp(equations.right[a] * inverse[a], 0.0F, bounds.most[a % lanes]);
  }
  if (lanes == 4) {
    sweep<4>(loops, equations, inverse, bounds, out.pressure);
  } else {
    sweep<8>(loops, equations, inverse, bounds, out.pressure);
  }
  soften(loops, bounds, equations, out.pressure);
}

void gather_gradient(const Loops& loops, const ReconstructionSettings& settings,
                     const ReconstructionScratch& scratch, Reconstruction& out) {
  const std::size_t n = loops.nodes(), lanes = static_cast<std::size_t>(loops.lanes);
  float roughness = 0.0F;
  for (std::size_t a = 0, before = n - lanes; a < n; ++a, ++before) {
    if (before == n) before = 0;
    out.gradient_x[a] = scratch.pull[4 * a] + scratch.pull[4 * before + 2];
    out.gradient_y[a] = scratch.pull[4 * a + 1] + scratch.pull[4 * before + 3];
    const float change = out.pressure[a] - out.pressure[before];
    roughness += change * change;
  }
  out.error += settings.smoothing * roughness +
               steepness_cost(loops, settings.bounds, out.pressure, out.gradient_x, out.gradient_y);
}

void reconstruct_plain(const CellTiles& cells, const Loops& loops,
                       const ReconstructionSettings& settings, Wanted wanted,
                       ReconstructionScratch& scratch, Reconstruction& out) {
  scratch.clear(loops);
  fit_cells(cells, loops, settings.sigma, scratch);
  solve_pressures(loops, settings, scratch, out);
  if (wanted == Wanted::Pressures) return;
  out.error = pull_segments(cells, loops, settings, scratch, out);
  gather_gradient(loops, settings, scratch, out);
}

}  // namespace prostm::planning
