#pragma once
/// The four costs of path refinement, Eqs. (2)–(5) of the paper, each with its gradient.
///
/// All are dimensionless: pressures over the frame's maximum, lengths in mm, angles in rad. Each
/// function returns weight·c and adds weight·∂c/∂x to `gradient`, which has one entry per sample.

#include <cstdint>
#include <span>
#include <vector>

#include "prostm/core/geometry.hpp"
#include "prostm/plan/detail/pressure_raster.hpp"

namespace prostm::planning {

/// Samples of closed paths, one path after the other, `samples` points each [mm].
struct PathSamples {
  std::span<const Vec2> x;
  int samples = 0;
};

/// Two samples that Eq. (4) compares: not consecutive on one path; first < second.
struct SamplePair {
  std::uint16_t first, second;
};

/// Writes the pairs of non-consecutive samples nearer than `radius` [mm], in lexicographic order,
/// each unordered pair once over all paths. The first and last samples of a path are consecutive.
/// @pre `pairs` has enough capacity if nothing may be allocated.
void near_pairs(const PathSamples& paths, double radius, std::vector<SamplePair>& pairs);

/// (P2), Eq. (2): c_p = −Σ p*(x_i).
double pressure_cost(const PressureRaster& raster, const PathSamples& paths, double weight,
                     std::span<Vec2> gradient);

/// (P3), Eq. (3): c_l = Σ (‖x_{i+1} − x_i‖ − segment)², segment = L/N [mm].
double length_cost(const PathSamples& paths, double segment, double weight,
                   std::span<Vec2> gradient);

/// (P4), Eq. (4): c_i = Σ max(σ − ‖x_j − x_i‖, 0)² over `pairs`, which must hold every pair nearer
/// than `sigma` [mm].
double intersection_cost(const PathSamples& paths, std::span<const SamplePair> pairs, double sigma,
                         double weight, std::span<Vec2> gradient);

/// (P5), Eq. (5): c_b = Σ θ_i², θ_i = atan2(b × a, b · a) with a = x_i − x_{i−1}, b = x_{i+1} −
/// x_i; θ_i = 0 where a or b vanishes.
double bending_cost(const PathSamples& paths, double weight, std::span<Vec2> gradient);

}  // namespace prostm::planning
