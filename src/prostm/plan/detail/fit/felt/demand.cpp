#include "prostm/plan/detail/fit/felt/demand.hpp"

#include <algorithm>
#include <cmath>

namespace prostm::planning {
namespace {

constexpr int kNorm = 64;            // exponent of the norm that approximates the maximum
constexpr float kNegligible = 0.3F;  // its power is 1e-33; smaller values would be slow denormals
constexpr float kLeastDuration = 1e-6F;
// distance that focal points should keep [mm]: two closer ones cost an array much more output
constexpr float kApart = 10.0F;
constexpr float kNearWeight = 1.0F;  // weight of (P24)

/// x to the power of kNorm − 1.
float almost_norm(float x) {
  float square = std::max(x, kNegligible), power = square;
  for (int n = 2; n < kNorm; n *= 2) {
    square *= square;
    power *= square;
  }
  return power;
}

}  // namespace

Demand::Demand() {
  passings_.reserve(kMaxPaths * kMoments);
}

void Demand::pass(const StepPath<float>& path, std::size_t begin, std::size_t samples) {
  const auto laps = static_cast<std::size_t>(path.laps());
  std::size_t next = 1, before = 0;
  for (std::size_t i = 0; i < kMoments; ++i) {
    const std::size_t in_lap = i * laps % kMoments;
    if (in_lap < before) next = 1;
    before = in_lap;
    const float time = static_cast<float>(in_lap) / static_cast<float>(kMoments);
    while (next < samples && path.time(next) <= time) ++next;
    Passing& at = passings_.emplace_back();
    at.moment = static_cast<std::uint16_t>(i);
    at.first = static_cast<std::uint16_t>(begin + next - 1);
    at.second = static_cast<std::uint16_t>(begin + next % samples);
    at.ends_lap = next == samples;
    const float from = path.time(next - 1), to = at.ends_lap ? 1.0F : path.time(next);
    at.duration = std::max(to - from, kLeastDuration);
    at.share = std::min((time - from) / at.duration, 1.0F);
  }
}

void Demand::set(std::span<const StepPath<float>> paths, std::size_t samples) {
  passings_.clear();
  for (std::size_t k = 0; k < paths.size(); ++k) pass(paths[k], k * samples, samples);
}

float Demand::normalise(std::span<float> pressure) {
  std::array<float, kMoments> demand{};
  for (const Passing& at : passings_)
    demand[at.moment] += (1.0F - at.share) * pressure[at.first] + at.share * pressure[at.second];
  const float most = *std::max_element(demand.begin(), demand.end());
  float sum = 0.0F;
  for (const float d : demand) sum += almost_norm(d / most) * d / most;
  const float output = most * std::pow(sum, 1.0F / static_cast<float>(kNorm));
  for (float& p : pressure) p /= output;
  for (std::size_t i = 0; i < kMoments; ++i) by_demand_[i] = almost_norm(demand[i] / output);
  return output;
}

void Demand::add_gradient(float along, std::span<float> gradient) const {
  for (const Passing& at : passings_) {
    const float pull = along * by_demand_[at.moment];
    gradient[at.first] -= (1.0F - at.share) * pull;
    gradient[at.second] -= at.share * pull;
  }
}

void Demand::add_by_time(float along, std::span<const float> pressure,
                         std::span<float> by_time) const {
  for (const Passing& at : passings_) {
    const float rise = (pressure[at.second] - pressure[at.first]) / at.duration;
    const float pull = along * by_demand_[at.moment] * rise;
    by_time[at.first] += (1.0F - at.share) * pull;
    if (!at.ends_lap) by_time[at.second] += at.share * pull;
  }
}

void Demand::add_place(const Passing& at, const StepPoints& points, float dx, float dy,
                       std::span<float> gradient_x, std::span<float> gradient_y,
                       std::span<float> by_time) const {
  const float before = 1.0F - at.share;
  gradient_x[at.first] += before * dx;
  gradient_y[at.first] += before * dy;
  gradient_x[at.second] += at.share * dx;
  gradient_y[at.second] += at.share * dy;
  // if the focal point passes these points later, it is less far along at this moment
  const float back = (dx * (points.x[at.second] - points.x[at.first]) +
                      dy * (points.y[at.second] - points.y[at.first])) /
                     at.duration;
  by_time[at.first] -= before * back;
  if (!at.ends_lap) by_time[at.second] -= at.share * back;
}

float Demand::near_cost(const StepPoints& points, std::span<float> gradient_x,
                        std::span<float> gradient_y, std::span<float> by_time) const {
  constexpr float kEach = kNearWeight / static_cast<float>(kMoments);
  const auto place = [](const Passing& at, std::span<const float> v) {
    return (1.0F - at.share) * v[at.first] + at.share * v[at.second];
  };
  float value = 0.0F;
  for (std::size_t a = 0; a < passings_.size(); ++a) {
    for (std::size_t b = a + kMoments; b < passings_.size(); b += kMoments) {
      const Passing &one = passings_[a], &other = passings_[b];
      const float dx = place(one, points.x) - place(other, points.x);
      const float dy = place(one, points.y) - place(other, points.y);
      const float near = 1.0F - (dx * dx + dy * dy) / (kApart * kApart);
      if (near <= 0.0F) continue;
      value += kEach * near * near;
      const float pull = -4.0F * kEach * near / (kApart * kApart);
      add_place(one, points, pull * dx, pull * dy, gradient_x, gradient_y, by_time);
      add_place(other, points, -pull * dx, -pull * dy, gradient_x, gradient_y, by_time);
    }
  }
  return value;
}

}  // namespace prostm::planning
