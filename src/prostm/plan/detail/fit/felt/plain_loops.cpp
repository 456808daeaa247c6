#include "prostm/plan/detail/fit/felt/plain_loops.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "prostm/core/units.hpp"
#include "prostm/plan/detail/pressure_raster.hpp"

namespace prostm::planning {
namespace {

/// Moments of the pressure on skin [mm].
struct Moments {
  Vec2 centre = Vec2::Zero(), axis = Vec2::UnitX();  // axis: direction of the largest variance
  double distance = 0.0, largest_deviation = 0.0;    // mean distance from the centre

  explicit Moments(const TargetField& target) {
    const auto add_up = [&](const auto& value) {
      auto sum = 0.0 * value(Vec2(0.0, 0.0));
      double whole = 0.0;
      for (int row = 0; row < target.rows; ++row) {
        for (int col = 0; col < target.cols; ++col) {
          const std::size_t i = target.index(row, col);
          if (target.skin[i] == 0) continue;
          sum += target.pressure[i] * value(kMmPerMetre * target.cell * Vec2(col, row));
          whole += target.pressure[i];
        }
      }
      return decltype(sum)(sum / whole);
    };
    centre.x() = add_up([](const Vec2& x) { return x.x(); });
    centre.y() = add_up([](const Vec2& x) { return x.y(); });
    distance = add_up([&](const Vec2& x) { return (x - centre).norm(); });
    const auto covariance = [&](int a, int b) {
      return add_up([&](const Vec2& x) { return (x - centre)[a] * (x - centre)[b]; });
    };
    const double xx = covariance(0, 0), xy = covariance(0, 1), yy = covariance(1, 1);
    const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
    axis = Vec2(std::cos(angle), std::sin(angle));
    largest_deviation = std::sqrt(0.5 * (xx + yy) + std::hypot(0.5 * (xx - yy), xy));
  }
};

/// Sets `loops` to an ellipse with evenly spaced samples. @param a, b half axes; a along `axis`.
void make_ellipse(const Moments& moments, double a, double b, Loops& loops) {
  constexpr std::size_t kCorners = 256;
  std::array<Vec2, kCorners + 1> corner;
  std::array<double, kCorners + 1> passed{};  // length up to the corner
  const Vec2 across(-moments.axis.y(), moments.axis.x());
  for (std::size_t i = 0; i <= kCorners; ++i) {
    const double angle = 2.0 * kPi * static_cast<double>(i) / kCorners;
    corner[i] = moments.centre + a * std::cos(angle) * moments.axis + b * std::sin(angle) * across;
    if (i > 0) passed[i] = passed[i - 1] + (corner[i] - corner[i - 1]).norm();
  }
  loops.reset(loops.samples, 1);
  std::size_t next = 1;
  for (int i = 0; i < loops.samples; ++i) {
    const double at = passed.back() * i / loops.samples;
    while (next < kCorners && passed[next] < at) ++next;
    const double share = (at - passed[next - 1]) / (passed[next] - passed[next - 1]);
    loops.set_point(i, 0, (1.0 - share) * corner[next - 1] + share * corner[next]);
  }
}

}  // namespace

void start_circle(const TargetField& target, const LoopBounds& bounds, Loops& loops) {
  const Moments moments(target);
  const double radius =
      std::clamp(2.0 * kPi * moments.distance, bounds.least_length, bounds.most_length) /
      (2.0 * kPi);
  make_ellipse(moments, radius, radius, loops);
}

void start_line(const TargetField& target, const LoopBounds& bounds, Loops& loops) {
  const Moments moments(target);
  // a flat loop is nearly four times as long as its half axis
  const double half = std::clamp(4.0 * std::sqrt(3.0) * moments.largest_deviation,
                                 bounds.least_length, bounds.most_length) /
                      4.0;
  make_ellipse(moments, std::max(half, 0.5 * bounds.width), 0.5 * bounds.width, loops);
}

}  // namespace prostm::planning
