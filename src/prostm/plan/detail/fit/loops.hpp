#pragma once
/// Closed paths in the layout of the optimiser of the presets `fast` and `best`: interleaved
/// floats.

#include <array>
#include <cstddef>
#include <span>

#include "prostm/core/geometry.hpp"
#include "prostm/plan/plan.hpp"

namespace prostm::planning {

inline constexpr std::size_t kMaxLoopNodes = static_cast<std::size_t>(kMaxPaths) * kMaxPathPoints;

/// One float per sample and path. Sample i of path k is at [i·lanes + k]: cyclic neighbours are
/// `lanes` apart, and a vector holds the same sample of several paths.
using NodeArray = std::array<float, kMaxLoopNodes>;

/// Up to `lanes` closed paths of `samples` points each. Lanes from `paths` on are unused and keep
/// their values.
struct Loops {
  int samples = 0, paths = 0;
  int lanes = 4;            ///< 4 or 8
  alignas(64) NodeArray x;  ///< [mm]
  alignas(64) NodeArray y;  ///< [mm]

  Loops() {
    x.fill(0.0F);
    y.fill(0.0F);
  }
  /// Sets the shape and puts all samples at the origin.
  void reset(int new_samples, int new_paths) {
    samples = new_samples;
    paths = new_paths;
    lanes = new_paths <= 4 ? 4 : 8;
    x.fill(0.0F);
    y.fill(0.0F);
  }
  std::size_t nodes() const {
    return static_cast<std::size_t>(samples) * static_cast<std::size_t>(lanes);
  }
  std::size_t node(int sample, int path) const {
    return static_cast<std::size_t>(sample * lanes + path);
  }
  Vec2 point(int sample, int path) const {
    const std::size_t i = node(sample, path);
    return {static_cast<double>(x[i]), static_cast<double>(y[i])};
  }
  void set_point(int sample, int path, const Vec2& p) {
    const std::size_t i = node(sample, path);
    x[i] = static_cast<float>(p.x());
    y[i] = static_cast<float>(p.y());
  }
};

}  // namespace prostm::planning
