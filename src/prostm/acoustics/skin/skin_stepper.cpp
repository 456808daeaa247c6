#include "prostm/acoustics/skin/skin_stepper.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "prostm/core/require.hpp"

namespace prostm {
namespace {

// an absorbing layer lies between these depths [m]; the bottom is fixed
constexpr double kClear = 0.08, kDepth = 0.5;
constexpr double kCoarsest = 5e-3;  // element [m]
constexpr double kGrowth = 1.2;     // largest growth of the elements with depth

/// Returns the heights of the elements, fine at the surface, where patterns fall off as e^{−kz}.
std::vector<double> elements(double finest) {
  std::vector<double> heights;
  double depth = 0.0;
  for (double h = finest; depth < kDepth; h = std::min(h * kGrowth, std::max(finest, kCoarsest))) {
    heights.push_back(h);
    depth += h;
  }
  return heights;
}

/// Returns the damping rate of the layer at a depth [1/s].
double drag(double depth, double speed) {
  const double into = std::max(0.0, (depth - kClear) / (kDepth - kClear));
  return 24.0 * speed / (kDepth - kClear) * into * into * into;
}

/// Cubic Hermite functions at s in 0..1 of an element of height h, and their depth derivatives.
struct Shape {
  std::array<double, 4> value, slope, curvature;
};
Shape shape(double s, double h) {
  const double t = 1.0 - s;
  return {{t * t * (1.0 + 2.0 * s), h * s * t * t, s * s * (1.0 + 2.0 * t), -h * s * s * t},
          {-6.0 * s * t / h, t * (1.0 - 3.0 * s), 6.0 * s * t / h, s * (3.0 * s - 2.0)},
          {(12.0 * s - 6.0) / (h * h), (6.0 * s - 4.0) / h, (6.0 - 12.0 * s) / (h * h),
           (6.0 * s - 2.0) / h}};
}

// Gauss's four points on 0..1: exact for products of cubics
constexpr std::array<double, 4> kPoints = {0.06943184420297371, 0.33000947820757187,
                                           0.66999052179242813, 0.93056815579702629};
constexpr std::array<double, 4> kWeights = {0.17392742256872693, 0.32607257743127307,
                                            0.32607257743127307, 0.17392742256872693};

}  // namespace

SkinStepper::SkinStepper(const SkinModel& model, double wave_number, double step)
    : step_(step), load_(1.0 / model.settings().density) {
  require_between("wave_number", wave_number, 1.0, 5000.0, "rad/m");
  require_between("step", step, 1e-9, 1e-3, "s");
  const SkinSettings& s = model.settings();
  slow_ = s.slow_speed * s.slow_speed / kRayleigh;
  rise_ = s.fast_speed * s.fast_speed / kRayleigh - slow_;
  const double tau = model.relaxation_time();
  keep_ = tau > 0.0 ? std::exp(-step / tau) : 0.0;
  renew_ = tau > 0.0 ? (1.0 - keep_) * tau / step : 0.0;

  // elements as fine as the step's stability permits, but not finer than needed
  const double speed = std::sqrt(slow_ + rise_);
  const double finest = std::min(std::max(0.15 / wave_number, 7.0 * speed * step), kCoarsest);
  if (finest * wave_number > 0.6 || finest < 7.0 * speed * step) {
    throw std::invalid_argument(
        "step must be at most 0.08/(k · shear speed) and 0.7 mm / shear speed, or it is unstable");
  }
  const std::vector<double> heights = elements(finest);
  const auto size = static_cast<Eigen::Index>(2 * heights.size());  // the last node is held
  std::vector<Eigen::Triplet<double>> mass, damping, stiffness;
  double top = 0.0;
  for (std::size_t e = 0; e < heights.size(); ++e) {
    const double h = heights[e], k = wave_number;
    for (std::size_t g = 0; g < kPoints.size(); ++g) {
      const Shape f = shape(kPoints[g], h);
      const double weight = kWeights[g] * h;
      const double rate = drag(top + kPoints[g] * h, speed);
      for (int a = 0; a < 4; ++a) {
        for (int b = 0; b < 4; ++b) {
          const auto row = static_cast<int>(2 * e) + a, col = static_cast<int>(2 * e) + b;
          if (row >= size || col >= size) continue;
          const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
          const double inertia = f.value[i] * f.value[j] + f.slope[i] * f.slope[j] / (k * k);
          const double shear =
              (f.curvature[i] / k + k * f.value[i]) * (f.curvature[j] / k + k * f.value[j]);
          mass.emplace_back(row, col, weight * inertia);
          damping.emplace_back(row, col, weight * inertia * rate);
          stiffness.emplace_back(row, col, weight * (4.0 * f.slope[i] * f.slope[j] + shear));
        }
      }
    }
    top += h;
  }
  Matrix loss(size, size);
  mass_.resize(size, size);
  stiffness_.resize(size, size);
  mass_.setFromTriplets(mass.begin(), mass.end());
  loss.setFromTriplets(damping.begin(), damping.end());
  stiffness_.setFromTriplets(stiffness.begin(), stiffness.end());
  receding_ = mass_ - 0.5 * step * loss;
  solver_.compute(mass_ + 0.5 * step * loss);
  now_ = before_ = memory_ = Eigen::VectorXd::Zero(size);
}

void SkinStepper::step(double pressure) {
  force_ = -(stiffness_ * (slow_ * now_ + rise_ * memory_));
  force_[0] += load_ * pressure;
  next_ = solver_.solve(step_ * step_ * force_ + 2.0 * (mass_ * now_) - receding_ * before_);
  memory_ = keep_ * memory_ + renew_ * (next_ - now_);
  before_.swap(now_);
  now_.swap(next_);
}

}  // namespace prostm
