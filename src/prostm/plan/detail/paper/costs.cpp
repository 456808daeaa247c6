#include "prostm/plan/detail/paper/costs.hpp"

#include <cmath>

namespace prostm::planning {
namespace {

/// Shorter vectors have no direction: their gradient is taken as zero [mm].
constexpr double kNoLength = 1e-9;

/// Index of the next sample on the closed path of sample i.
std::size_t next(std::size_t i, std::size_t n) {
  return (i + 1) % n == 0 ? i + 1 - n : i + 1;
}

}  // namespace

void near_pairs(const PathSamples& paths, double radius, std::vector<SamplePair>& pairs) {
  pairs.clear();
  const auto n = static_cast<std::size_t>(paths.samples);
  for (std::size_t i = 0; i < paths.x.size(); ++i) {
    const std::size_t begin = i / n * n;
    for (std::size_t j = i + 1; j < paths.x.size(); ++j) {
      const bool consecutive = j == i + 1 ? j < begin + n : (i == begin && j == begin + n - 1);
      if (consecutive || (paths.x[j] - paths.x[i]).squaredNorm() >= radius * radius) continue;
      pairs.push_back({static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(j)});
    }
  }
}

double pressure_cost(const PressureRaster& raster, const PathSamples& paths, double weight,
                     std::span<Vec2> gradient) {
  double sum = 0.0;
  for (std::size_t i = 0; i < paths.x.size(); ++i) {
    const PressureSample p = raster.sample(paths.x[i]);
    sum -= p.value;
    gradient[i] -= weight * p.gradient;
  }
  return weight * sum;
}

double length_cost(const PathSamples& paths, double segment, double weight,
                   std::span<Vec2> gradient) {
  double sum = 0.0;
  const auto n = static_cast<std::size_t>(paths.samples);
  for (std::size_t i = 0; i < paths.x.size(); ++i) {
    const std::size_t j = next(i, n);
    const Vec2 d = paths.x[j] - paths.x[i];
    const double length = d.norm(), excess = length - segment;
    sum += excess * excess;
    if (length < kNoLength) continue;
    const Vec2 g = (2.0 * weight * excess / length) * d;
    gradient[j] += g;
    gradient[i] -= g;
  }
  return weight * sum;
}

double intersection_cost(const PathSamples& paths, std::span<const SamplePair> pairs, double sigma,
                         double weight, std::span<Vec2> gradient) {
  double sum = 0.0;
  for (const SamplePair pair : pairs) {
    const Vec2 d = paths.x[pair.second] - paths.x[pair.first];
    const double squared = d.squaredNorm();
    if (squared >= sigma * sigma) continue;
    const double distance = std::sqrt(squared), overlap = sigma - distance;
    sum += overlap * overlap;
    if (distance < kNoLength) continue;
    const Vec2 g = (2.0 * weight * overlap / distance) * d;
    gradient[pair.first] += g;
    gradient[pair.second] -= g;
  }
  return weight * sum;
}

// With a = x_i − x_{i−1} and b = x_{i+1} − x_i, θ = atan2(b × a, b · a) is the direction of a minus
// that of b. The direction of a turns by (−a_y, a_x)/‖a‖² per unit of a, so no inverse trigonometry
// is needed for the gradient.
double bending_cost(const PathSamples& paths, double weight, std::span<Vec2> gradient) {
  double sum = 0.0;
  const auto n = static_cast<std::size_t>(paths.samples);
  for (std::size_t begin = 0; begin < paths.x.size(); begin += n) {
    std::size_t before = begin + n - 1;
    for (std::size_t i = begin; i < begin + n; before = i++) {
      const std::size_t after = next(i, n);
      const Vec2 a = paths.x[i] - paths.x[before], b = paths.x[after] - paths.x[i];
      const double aa = a.squaredNorm(), bb = b.squaredNorm();
      if (aa < kNoLength * kNoLength || bb < kNoLength * kNoLength) continue;
      const double theta = std::atan2(cross(b, a), b.dot(a));
      sum += theta * theta;
      const double scale = 2.0 * weight * theta;
      const Vec2 by_a = (scale / aa) * Vec2(-a.y(), a.x()),
                 by_b = (-scale / bb) * Vec2(-b.y(), b.x());
      gradient[before] -= by_a;
      gradient[i] += by_a - by_b;
      gradient[after] += by_b;
    }
  }
  return weight * sum;
}

}  // namespace prostm::planning
