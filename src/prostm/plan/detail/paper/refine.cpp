#include "prostm/plan/detail/paper/refine.hpp"

#include <algorithm>
#include <cmath>

namespace prostm::planning {
namespace {

constexpr double kArmijo = 1e-4;  // share of the linear decrease that a step must reach
constexpr double kFirstStep =
    0.05;  // about the inverse of the length term's largest curvature [mm²]
constexpr double kLargestStep = 1e3;     // keeps trials finite where the cost is flat [mm²]
constexpr double kSmallestStep = 1e-10;  // a line search ends here at a minimum, or at a kink
constexpr double kTolerance = 1e-7;      // relative decrease of the cost that counts as converged
constexpr double kPairSlack = 2.0;  // move of a sample after which near pairs are listed again [mm]

double squared_norm(std::span<const Vec2> v) {
  double sum = 0.0;
  for (const Vec2& x : v) sum += x.squaredNorm();
  return sum;
}

}  // namespace

CostSettings::CostSettings(const PlanSettings& settings)
    : pressure(settings.weight_pressure),
      length(settings.weight_length),
      intersection(settings.weight_intersection),
      bending(settings.weight_bending),
      segment(kMmPerMetre * settings.max_length() / settings.samples),
      sigma(kMmPerMetre * settings.sigma) {}

Refiner::Refiner(const CostSettings& costs, int max_paths, int samples, int max_iterations)
    : costs_(costs), samples_(samples), max_iterations_(max_iterations) {
  const auto n = static_cast<std::size_t>(max_paths) * static_cast<std::size_t>(samples);
  pairs_.reserve(n * (n - 1) / 2);
  for (std::vector<Vec2>* v : {&paired_at_, &gradient_, &trial_, &trial_gradient_}) v->reserve(n);
}

void Refiner::update_pairs(std::span<const Vec2> x) {
  // pairs that were farther than σ + 2·slack cannot have come nearer than σ while every sample
  // moved less than the slack
  const auto moved = [&](std::size_t i) {
    return (x[i] - paired_at_[i]).squaredNorm() > kPairSlack * kPairSlack;
  };
  bool stale = paired_at_.size() != x.size();
  for (std::size_t i = 0; i < x.size() && !stale; ++i) stale = moved(i);
  if (!stale) return;
  paired_at_.assign(x.begin(), x.end());
  near_pairs({x, samples_}, costs_.sigma + 2.0 * kPairSlack, pairs_);
}

double Refiner::evaluate(const PressureRaster& raster, std::span<const Vec2> x,
                         std::span<Vec2> gradient) {
  update_pairs(x);
  std::fill(gradient.begin(), gradient.end(), Vec2::Zero());
  const PathSamples paths{x, samples_};
  return pressure_cost(raster, paths, costs_.pressure, gradient) +
         length_cost(paths, costs_.segment, costs_.length, gradient) +
         intersection_cost(paths, pairs_, costs_.sigma, costs_.intersection, gradient) +
         bending_cost(paths, costs_.bending, gradient);
}

// The paper does not specify the first trial of its line search. Here it is the Barzilai-Borwein
// step s·s / s·y (s the last change of x, y that of the gradient), the inverse of the last
// curvature along a step [Barzilai and Borwein 1988]. Steepest descent with it needs a fraction of
// the steps that doubling and halving the last step needs.
RefineResult Refiner::run(const PressureRaster& raster, std::span<Vec2> x) {
  for (std::vector<Vec2>* v : {&gradient_, &trial_, &trial_gradient_}) v->resize(x.size());
  RefineResult result;
  result.cost = evaluate(raster, x, gradient_);
  result.evaluations = 1;

  double step = kFirstStep;
  while (result.iterations < max_iterations_) {
    // halve the step until the cost falls enough
    const double slope = squared_norm(gradient_);
    double cost = 0.0;
    for (; step > kSmallestStep; step *= 0.5) {
      for (std::size_t i = 0; i < x.size(); ++i) trial_[i] = x[i] - step * gradient_[i];
      cost = evaluate(raster, trial_, trial_gradient_);
      ++result.evaluations;
      if (cost <= result.cost - kArmijo * step * slope) break;
    }
    if (step <= kSmallestStep) break;

    // take the step; s = −step·gradient, so that s·s / s·y = step·slope / −gradient·y
    ++result.iterations;
    double curvature = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] = trial_[i];
      curvature += gradient_[i].dot(gradient_[i] - trial_gradient_[i]);
    }
    if (curvature > 0.0) {
      step = step * slope < kLargestStep * curvature ? step * slope / curvature : kLargestStep;
    } else {
      step = std::min(2.0 * step, kLargestStep);
    }
    const double decrease = result.cost - cost;
    result.cost = cost;
    gradient_.swap(trial_gradient_);
    if (decrease <= kTolerance * (1.0 + std::abs(cost))) break;
  }
  return result;
}

}  // namespace prostm::planning
