#include "prostm/plan/detail/fit/felt/rise_cost.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace prostm::planning {
namespace {

constexpr float kWeight = 0.1F;        // weight of the squared excess of √p over the highest √p
constexpr float kLeastLength = 1e-3F;  // lower bound of a segment's length [mm]

}  // namespace

float rise_cost(const StepPoints& points, const PlayBounds& bounds, int pieces,
                std::span<const float> root, std::span<float> gradient, std::span<float> gradient_x,
                std::span<float> gradient_y) {
  const auto n = static_cast<std::size_t>(points.samples);
  const auto lower = [](float a, float b) { return std::abs(a) < std::abs(b); };
  const auto top =
      static_cast<std::size_t>(std::max_element(root.begin(), root.end(), lower) - root.begin());
  // √p relative to the highest; its sign has no meaning, since p is its square
  const float scale = 1.0F / std::abs(root[top]), least = 0.5F / static_cast<float>(pieces);
  const auto add = [&](std::size_t point, float by_share) {
    gradient[point] += std::copysign(scale, root[point]) * by_share;
  };
  float value = 0.0F, by_highest = 0.0F;
  for (std::size_t i = 0; i < root.size(); ++i) {
    const std::size_t k = i / n, j = points.next(i);
    const auto [low, high] = lower(root[i], root[j]) ? std::pair(i, j) : std::pair(j, i);
    const float dx = points.x[j] - points.x[i], dy = points.y[j] - points.y[i];
    const float length = std::max(std::hypot(dx, dy), kLeastLength);
    // assumes that the plan's highest pressure is at its bound
    const float slope = bounds.slope[k] / std::sqrt(bounds.most[k]);
    const float u = scale * std::abs(root[low]), v = scale * std::abs(root[high]);
    const float d = slope * length;
    const float most = std::sqrt(u * u + 2.0F * u * d + least * d * d);
    const float excess = v - most;
    if (excess <= 0.0F) continue;
    value += kWeight * excess * excess;
    const float by_v = 2.0F * kWeight * excess, by_u = -by_v * (u + d) / most;
    add(high, by_v);
    add(low, by_u);
    by_highest -= by_u * u + by_v * v;
    if (gradient_x.empty()) continue;
    const float by_length = -by_v * (u + least * d) / most * slope / length;
    gradient_x[j] += by_length * dx;
    gradient_y[j] += by_length * dy;
    gradient_x[i] -= by_length * dx;
    gradient_y[i] -= by_length * dy;
  }
  add(top, by_highest);
  return value;
}

}  // namespace prostm::planning
