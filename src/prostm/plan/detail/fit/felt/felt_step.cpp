#include "prostm/plan/detail/fit/felt/felt_step.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "prostm/plan/detail/fit/felt/rise_cost.hpp"
#include "prostm/plan/detail/fit/raster/cell_tiles.hpp"

namespace prostm::planning {
namespace {

/// Sets the pressures between the chosen points.
void join(const Loops& loops, const LapStarts& starts, int pieces, NodeArray& pressure) {
  for (int k = 0; k < loops.paths; ++k) {
    const auto at = [&](int i) -> float& {
      return pressure[loops.node(
          starts[static_cast<std::size_t>(k)].sample(i % loops.samples, loops.samples), k)];
    };
    for (int i = 0; i < loops.samples; ++i) {
      const int before = i / pieces * pieces;
      const float share = static_cast<float>(i - before) / static_cast<float>(pieces);
      if (i != before) at(i) = (1.0F - share) * at(before) + share * at(before + pieces);
    }
  }
}

}  // namespace

FeltStep::FeltStep(const PlanSettings& settings, const FeltTuning& tuning, const FeltScope& scope,
                   FeltLoudness loudness)
    : tuning_(tuning),
      loudness_(loudness),
      problem_(settings, scope),
      descent_((settings.felt_points ? 3 : 1) * most_felt_points(settings)) {
  const std::size_t most = most_felt_points(settings);
  kept_.points.reserve(most);
  node_.reserve(most);
  for (auto* list : {&x_, &y_, &root_, &fitted_}) list->reserve(most);
  if (settings.felt_points) variables_.reserve(3 * most);
}

void FeltStep::forget() {
  kept_.points.clear();
  kept_.from = Kept::From::Nothing;
}

void FeltStep::move(const Vec2& shift) {
  for (Chosen& point : kept_.points) {
    point.x += static_cast<float>(shift.x());
    point.y += static_cast<float>(shift.y());
  }
}

void FeltStep::set_target(const TargetField& target, double maximum, double sigma) {
  problem_.set_target(target, maximum, sigma);
}

/// Takes every `pieces`-th point of each path, in the order in which the focal point passes them.
StepPoints FeltStep::take_points(const Loops& loops, const LapStarts& starts,
                                 const CommonLoop& loop, int pieces) {
  const int samples = loops.samples / pieces;
  node_.clear();
  x_.clear();
  y_.clear();
  for (int k = 0; k < loops.paths; ++k) {
    for (int i = 0; i < samples; ++i) {
      const int sample = starts[static_cast<std::size_t>(k)].sample(i * pieces, loops.samples);
      node_.push_back(loops.node(sample, k));
      x_.push_back(loops.x[node_.back()]);
      y_.push_back(loops.y[node_.back()]);
    }
  }
  const StepPoints points{samples, x_, y_};
  problem_.set_points(points, loop);
  return points;
}

/// Sets fitted_ to √p of the fit at the points.
void FeltStep::take_fit(const NodeArray& pressure) {
  constexpr float kTiny = 1e-3F;  // so that the fit is not silent everywhere
  fitted_.clear();
  for (const std::size_t node : node_)
    fitted_.push_back(std::max(std::sqrt(pressure[node]), kTiny));
}

float FeltStep::least_root() const {
  return tuning_.least_root * *std::max_element(fitted_.begin(), fitted_.end());
}

void FeltStep::begin_at_fit() {
  const float least = least_root();
  root_.clear();
  for (const float root : fitted_) root_.push_back(std::max(root, least));
}

/// Sets the start of a descent: the fit's √p plus the change of the previous plan at the nearest
/// kept point, or the √p of moved points; where no kept point is near, the fit's √p.
void FeltStep::begin_at_kept() {
  begin_at_fit();
  const float least = least_root();
  const bool of_plan = kept_.from == Kept::From::LastPlan;
  const float reach = of_plan ? tuning_.near : tuning_.moved_near;
  for (std::size_t j = 0; j < node_.size(); ++j) {
    const Chosen* nearest = nullptr;
    float distance = reach * reach;
    for (const Chosen& point : kept_.points) {
      const float dx = point.x - x_[j], dy = point.y - y_[j], square = dx * dx + dy * dy;
      if (square >= distance) continue;
      distance = square;
      nearest = &point;
    }
    if (nearest != nullptr)
      root_[j] = std::max(of_plan ? fitted_[j] + nearest->more : nearest->root, least);
  }
}

void FeltStep::keep(Kept::From from, const FeltProblem::Loudness& wanted) {
  kept_.points.clear();
  for (std::size_t j = 0; j < node_.size(); ++j)
    kept_.points.push_back({x_[j], y_[j], root_[j], root_[j] - fitted_[j]});
  kept_.from = from;
  kept_.wanted = wanted;
}

/// Lowers the cost as a function of √p, from the kept points, or from the fit if that costs less
/// than the start from the previous plan. @return evaluations used.
int FeltStep::descend(const QuasiNewton::Cost& cost, float fit_cost) {
  const FeltEffort& moved = kept_.moved_on ? tuning_.from_moved_on : tuning_.from_moved;
  const FeltEffort* effort = kept_.from == Kept::From::MovedPoints ? &moved
                             : kept_.from == Kept::From::LastPlan  ? &tuning_.from_last_plan
                                                                   : &tuning_.from_fit;
  begin_at_kept();
  int evaluations = 0;
  if (descent_.begin(cost, root_) > fit_cost && kept_.from == Kept::From::LastPlan) {
    // the paths have changed too much for the previous plan's changes to help
    begin_at_fit();
    descent_.begin(cost, root_);
    ++evaluations;
    effort = &tuning_.from_fit_again;
  }
  evaluations += descent_.run(cost, effort->first_step, effort->evaluations, root_);
  for (float& root : root_) root = std::abs(root);  // the sign has no meaning: p is its square
  return evaluations;
}

/// Scales √p to this loudness, or to the highest, as far as the limits of output and pressure
/// allow.
void FeltStep::make_as_loud(const FeltProblem::Loudness& wanted, float most_pressure) {
  problem_.evaluate(root_);
  const FeltProblem::Loudness found = problem_.loudness();
  const float highest = *std::max_element(root_.begin(), root_.end());
  float scale = std::min(wanted.output / found.output, most_pressure / (highest * highest));
  if (loudness_ == FeltLoudness::Kept) scale = std::min(scale, wanted.felt / found.felt);
  for (float& root : root_) root *= std::sqrt(scale);
}

int FeltStep::choose_pressures(const Loops& loops, const LapStarts& starts, const CommonLoop& loop,
                               int pieces, const PlayBounds& bounds, NodeArray& pressure) {
  const StepPoints points = take_points(loops, starts, loop, pieces);
  take_fit(pressure);
  const bool moved = kept_.from == Kept::From::MovedPoints;
  if (moved) begin_at_kept();
  const bool same_loudness =
      moved && loudness_ == FeltLoudness::Kept;  // that of the fit before points moved
  const float fit_cost = same_loudness ? 0.0F : problem_.keep_loudness(moved ? root_ : fitted_);
  const FeltProblem::Loudness wanted = moved ? kept_.wanted : problem_.loudness();
  const auto cost = [&](std::span<const float> root, std::span<float> gradient) {
    const float value = problem_.evaluate(root);
    problem_.gradient(root, gradient);
    return moved ? value + rise_cost(points, bounds, pieces, root, gradient, {}, {}) : value;
  };
  // std::function stores a reference without allocating
  const int evaluations = descend(std::ref(cost), fit_cost);
  make_as_loud(wanted, bounds.most[0]);
  for (std::size_t j = 0; j < node_.size(); ++j) pressure[node_[j]] = root_[j] * root_[j];
  keep(Kept::From::LastPlan, wanted);
  join(loops, starts, pieces, pressure);
  return evaluations + (moved ? 1 : 2);
}

FeltRating FeltStep::rate(const Loops& loops, const LapStarts& starts, const CommonLoop& loop,
                          const NodeArray& pressure) {
  take_points(loops, starts, loop, 1);
  take_fit(pressure);
  problem_.evaluate(fitted_);
  return problem_.rating();
}

/// Computes (P21). The variables are √p, then x and y of all points in FeltTuning::unit.
float FeltStep::moved_cost(const CommonLoop& loop, const ShapeSettings& shape,
                           const PlayBounds& bounds, int pieces, std::span<const float> x,
                           std::span<float> gradient) {
  const std::size_t n = node_.size();
  const StepPoints points{loops_.samples, x_, y_};
  for (std::size_t j = 0; j < n; ++j) {
    x_[j] = loops_.x[node_[j]] = tuning_.unit * x[n + j];
    y_[j] = loops_.y[node_[j]] = tuning_.unit * x[2 * n + j];
  }
  problem_.set_points(points, loop);
  float value = problem_.evaluate(x.first(n));
  problem_.gradient(x.first(n), gradient.first(n));
  value += problem_.slide(gradient.subspan(n, n), gradient.subspan(2 * n, n));
  value += rise_cost(points, bounds, pieces, x.first(n), gradient.first(n), gradient.subspan(n, n),
                     gradient.subspan(2 * n, n));
  pairs_.update(loops_, shape);
  shape_x_.fill(0.0F);
  shape_y_.fill(0.0F);
  const float share = kUnitArea / problem_.square();
  value += share * shape_cost(loops_, shape, pairs_.list(), shape_x_, shape_y_);
  for (std::size_t j = 0; j < n; ++j) {
    gradient[n + j] = tuning_.unit * (gradient[n + j] + share * shape_x_[node_[j]]);
    gradient[2 * n + j] = tuning_.unit * (gradient[2 * n + j] + share * shape_y_[node_[j]]);
  }
  return value;
}

int FeltStep::move_points(const LapStarts& starts, const CommonLoop& loop,
                          const ShapeSettings& shape, const PlayBounds& bounds, int pieces,
                          const NodeArray& pressure, Loops& loops) {
  take_points(loops, starts, loop, 1);
  take_fit(pressure);
  begin_at_kept();
  const bool again = kept_.from == Kept::From::MovedPoints;
  if (!again) {
    kept_.moved_on = kept_.from == Kept::From::LastPlan;
    problem_.keep_loudness(fitted_);
  }
  const FeltProblem::Loudness wanted = again ? kept_.wanted : problem_.loudness();
  loops_ = loops;
  pairs_.clear();
  const std::size_t n = node_.size();
  variables_.resize(3 * n);
  for (std::size_t j = 0; j < n; ++j) {
    variables_[j] = root_[j];
    variables_[n + j] = x_[j] / tuning_.unit;
    variables_[2 * n + j] = y_[j] / tuning_.unit;
  }
  const auto cost = [&](std::span<const float> x, std::span<float> gradient) {
    return moved_cost(loop, shape, bounds, pieces, x, gradient);
  };
  const FeltEffort& effort = again            ? tuning_.moving_again
                             : kept_.moved_on ? tuning_.moving_on
                                              : tuning_.moving;
  descent_.begin(std::ref(cost), variables_);
  const int evaluations =
      descent_.run(std::ref(cost), effort.first_step, effort.evaluations, variables_);
  for (std::size_t j = 0; j < n; ++j) {
    root_[j] = std::abs(variables_[j]);
    x_[j] = loops.x[node_[j]] = tuning_.unit * variables_[n + j];
    y_[j] = loops.y[node_[j]] = tuning_.unit * variables_[2 * n + j];
  }
  keep(Kept::From::MovedPoints, wanted);
  return again ? evaluations : evaluations + 1;
}

}  // namespace prostm::planning
