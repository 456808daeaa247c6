#include "prostm/plan/detail/fit/loop_shape.hpp"

#include <algorithm>
#include <cmath>

namespace prostm::planning {
namespace {

constexpr float kPairMargin = 4.0F;  // margin by which listed pairs may exceed their distance [mm]
constexpr float kTiny = 1e-6F;       // [mm]

/// Edges of the loops, padded by one sample of each path at either end, so that every edge has two
/// neighbours.
struct Edges {
  static constexpr std::size_t kCapacity = kMaxLoopNodes + 2 * kMaxPaths;
  alignas(64) std::array<float, kCapacity> ux, uy, length;  // unit vectors; lengths [mm]

  explicit Edges(const Loops& loops) {
    const std::size_t n = loops.nodes(), lanes = static_cast<std::size_t>(loops.lanes);
    for (std::size_t a = 0; a < n; ++a) {
      const std::size_t b = a + lanes < n ? a + lanes : a + lanes - n;
      ux[a + lanes] = loops.x[b] - loops.x[a];
      uy[a + lanes] = loops.y[b] - loops.y[a];
    }
    for (std::size_t e = lanes; e < n + lanes; ++e) {
      length[e] = std::max(std::sqrt(ux[e] * ux[e] + uy[e] * uy[e]), kTiny);
      ux[e] /= length[e];
      uy[e] /= length[e];
    }
    for (std::size_t k = 0; k < lanes; ++k) {
      ux[k] = ux[n + k];
      uy[k] = uy[n + k];
      ux[n + lanes + k] = ux[lanes + k];
      uy[n + lanes + k] = uy[lanes + k];
    }
  }
};

/// Returns the sum over the samples of each path.
std::array<float, kMaxPaths> sum_by_path(const Loops& loops, const float* values) {
  std::array<float, kMaxPaths> sum{};
  const std::size_t n = loops.nodes(), lanes = static_cast<std::size_t>(loops.lanes);
  for (std::size_t first = 0; first < n; first += lanes) {
    for (std::size_t k = 0; k < lanes; ++k) sum[k] += values[first + k];
  }
  return sum;
}

/// Cost of length and bending. The gradient with respect to an edge acts on both of its ends.
float edge_cost(const Loops& loops, const ShapeSettings& settings, NodeArray& gradient_x,
                NodeArray& gradient_y) {
  const std::size_t n = loops.nodes(), lanes = static_cast<std::size_t>(loops.lanes);
  const Edges edge(loops);
  const std::array<float, kMaxPaths> total = sum_by_path(loops, edge.length.data() + lanes);

  // for each path: its mean segment length, and by how much that is too long or too short
  std::array<float, kMaxPaths> mean{}, excess{}, weight{};
  const auto samples = static_cast<float>(loops.samples);
  float cost = 0.0F;
  for (std::size_t k = 0; k < static_cast<std::size_t>(loops.paths); ++k) {
    mean[k] = total[k] / samples;
    excess[k] = std::max(mean[k] - settings.most_length[k] / samples, 0.0F) -
                std::max(settings.least_length / samples - mean[k], 0.0F);
    weight[k] = 1.0F;
    cost += settings.weight_length * samples * excess[k] * excess[k];
  }

  alignas(64) NodeArray gx, gy, cost_of;  // with respect to the edge
  for (std::size_t first = 0; first < n; first += lanes) {
    for (std::size_t k = 0; k < lanes; ++k) {
      const std::size_t a = first + k, e = a + lanes;
      const float ux = edge.ux[e], uy = edge.uy[e], s = edge.length[e];
      const float before = ux * edge.ux[e - lanes] + uy * edge.uy[e - lanes];
      const float after = ux * edge.ux[e + lanes] + uy * edge.uy[e + lanes];
      const float uneven = s - mean[k];
      cost_of[a] = settings.weight_length * uneven * uneven +
                   2.0F * settings.weight_bending * (1.0F - before);
      const float pull = 2.0F * settings.weight_length * (uneven + excess[k]);
      const float bend = 2.0F * settings.weight_bending / s;
      gx[a] =
          weight[k] *
          (pull * ux - bend * (edge.ux[e - lanes] + edge.ux[e + lanes] - (before + after) * ux));
      gy[a] =
          weight[k] *
          (pull * uy - bend * (edge.uy[e - lanes] + edge.uy[e + lanes] - (before + after) * uy));
    }
  }
  for (std::size_t a = 0, before = n - lanes; a < n; ++a, ++before) {
    if (before == n) before = 0;
    gradient_x[a] += gx[before] - gx[a];
    gradient_y[a] += gy[before] - gy[a];
  }
  const std::array<float, kMaxPaths> costs = sum_by_path(loops, cost_of.data());
  for (std::size_t k = 0; k < static_cast<std::size_t>(loops.paths); ++k) cost += costs[k];
  return cost;
}

}  // namespace

SpacedPairs::SpacedPairs() {
  pairs_.reserve(kMaxLoopNodes * (kMaxLoopNodes - 1) / 2);
}

bool SpacedPairs::has_moved(const Loops& loops) const {
  constexpr float kFarthest = 0.25F * kPairMargin * kPairMargin;  // both samples may move
  float farthest = 0.0F;
  for (std::size_t a = 0; a < loops.nodes(); ++a) {
    const float dx = loops.x[a] - listed_x_[a], dy = loops.y[a] - listed_y_[a];
    farthest = std::max(farthest, dx * dx + dy * dy);
  }
  return farthest > kFarthest;
}

void SpacedPairs::update(const Loops& loops, const ShapeSettings& settings) {
  if (listed_ && !has_moved(loops)) return;
  listed_ = true;
  listed_x_ = loops.x;
  listed_y_ = loops.y;
  pairs_.clear();

  // distance that two samples of one path should keep, per step between them along it
  const Edges edge(loops);
  const auto lanes = static_cast<std::size_t>(loops.lanes);
  const std::array<float, kMaxPaths> total = sum_by_path(loops, edge.length.data() + lanes);
  std::array<float, kMaxPaths> chord{};
  for (std::size_t k = 0; k < static_cast<std::size_t>(loops.paths); ++k) {
    const float longest =
        std::min(std::max(total[k], settings.least_length), settings.most_length[k]);
    chord[k] = kLeastChord * longest / static_cast<float>(loops.samples);
  }
  const auto paths = static_cast<std::size_t>(loops.paths);
  near_.set(loops.x, loops.y, loops.nodes(), settings.spacing + kPairMargin);
  for (std::size_t i = 0; i < near_.size(); ++i) {
    const auto [a, b] = near_[i];
    const std::size_t k = a & (lanes - 1), l = b & (lanes - 1);
    if (k >= paths || l >= paths) continue;
    float distance = settings.spacing;
    if (k == l) {
      const auto apart = static_cast<int>((b - a) / lanes);
      const int steps = std::min(apart, loops.samples - apart);
      if (steps < 2) continue;
      distance = std::min(distance, chord[k] * static_cast<float>(steps));
    }
    pairs_.push_back({static_cast<std::uint16_t>(a), static_cast<std::uint16_t>(b), distance});
  }
}

float shape_cost(const Loops& loops, const ShapeSettings& settings,
                 const std::vector<SpacedPair>& pairs, NodeArray& gradient_x,
                 NodeArray& gradient_y) {
  float cost = edge_cost(loops, settings, gradient_x, gradient_y);
  for (const SpacedPair& pair : pairs) {
    const float dx = loops.x[pair.second] - loops.x[pair.first];
    const float dy = loops.y[pair.second] - loops.y[pair.first];
    const float squared = dx * dx + dy * dy;
    if (squared >= pair.distance * pair.distance) continue;
    const float distance = std::max(std::sqrt(squared), kTiny), lack = pair.distance - distance;
    cost += settings.weight_spacing * lack * lack;
    const float push = 2.0F * settings.weight_spacing * lack / distance;
    gradient_x[pair.first] += push * dx;
    gradient_y[pair.first] += push * dy;
    gradient_x[pair.second] -= push * dx;
    gradient_y[pair.second] -= push * dy;
  }
  return cost;
}

}  // namespace prostm::planning
