#include "prostm/plan/detail/fit/felt/felt_step.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "prostm/plan/detail/fit/felt/rise_cost.hpp"
#include "prostm/plan/detail/fit/raster/cell_tiles.hpp"

namespace prostm::planning {
namespace {

constexpr float kLeastRoot = 0.03F;  // √p at the beginning, over the largest: at 0 it would stick
constexpr float kPerUnit = 5.0F;     // [mm] that a step of points is as long as a step of 1 in √p
// a point goes on from one of the last plan, or of moved points, this near [mm]
constexpr float kNear = 2.0F, kMovedNear = 6.0F;

/// How far a descent goes: evaluations at most, and the length of its first step in √p.
struct Effort {
  int evaluations;
  float first_step;
};
constexpr Effort kMoving = {50, 0.5F}, kMovingAgain = {25, 0.5F};  // of points, in later rounds
// of pressures, by where it begins: From::Fit, FitAgain, LastPlan, MovedPoints
constexpr std::array kChoosing = {Effort{12, 0.5F}, Effort{6, 0.5F}, Effort{6, 0.3F},
                                  Effort{30, 0.5F}};

}  // namespace

FeltStep::FeltStep(const PlanSettings& settings)
    : problem_(settings), descent_((settings.felt_points ? 3 : 1) * most_felt_points(settings)) {
  const std::size_t most = most_felt_points(settings);
  last_.reserve(most);
  node_.reserve(most);
  for (auto* list : {&x_, &y_, &root_, &fitted_}) list->reserve(most);
  if (settings.felt_points) variables_.reserve(3 * most);
}

void FeltStep::forget() {
  last_.clear();
  from_ = From::Fit;
}

void FeltStep::move(const Vec2& shift) {
  for (Chosen& point : last_) {
    point.x += static_cast<float>(shift.x());
    point.y += static_cast<float>(shift.y());
  }
}

void FeltStep::set_target(const TargetField& target, double maximum, double sigma) {
  problem_.set_target(target, maximum, sigma);
}

/// Takes every so many-th point of each path in the order in which it is passed.
void FeltStep::take_points(const Loops& loops, const LapStarts& starts, int pieces) {
  samples_ = loops.samples / pieces;
  node_.clear();
  x_.clear();
  y_.clear();
  for (int k = 0; k < loops.paths; ++k) {
    for (int i = 0; i < samples_; ++i) {
      const int sample = starts[static_cast<std::size_t>(k)].sample(i * pieces, loops.samples);
      node_.push_back(loops.node(sample, k));
      x_.push_back(loops.x[node_.back()]);
      y_.push_back(loops.y[node_.back()]);
    }
  }
  problem_.set_points(points(), loop_);
}

/// Takes the pressures of the fit.
void FeltStep::fit(const NodeArray& pressure) {
  constexpr float kTiny = 1e-3F;  // so that the fit is never silent throughout
  fitted_.clear();
  for (const std::size_t node : node_)
    fitted_.push_back(std::max(std::sqrt(pressure[node]), kTiny));
}

/// Sets √p to where the descent begins: to the fit's, changed as the last plan's were; or to those
/// of moved points.
void FeltStep::begin() {
  const float least = kLeastRoot * *std::max_element(fitted_.begin(), fitted_.end());
  root_.clear();
  for (std::size_t j = 0; j < node_.size(); ++j) {
    const Chosen* nearest = nullptr;
    float distance = from_ == From::LastPlan ? kNear * kNear : kMovedNear * kMovedNear;
    for (const Chosen& point : last_) {
      const float dx = point.x - x_[j], dy = point.y - y_[j], square = dx * dx + dy * dy;
      if (square >= distance) continue;
      distance = square;
      nearest = &point;
    }
    float root = fitted_[j];
    if (nearest != nullptr) root = from_ == From::LastPlan ? root + nearest->more : nearest->root;
    root_.push_back(std::max(root, least));
  }
}

void FeltStep::remember(From from) {
  last_.clear();
  for (std::size_t j = 0; j < node_.size(); ++j)
    last_.push_back({x_[j], y_[j], root_[j], root_[j] - fitted_[j]});
  from_ = from;
}

/// Sets the pressures between the chosen points.
void FeltStep::join(const Loops& loops, const LapStarts& starts, int pieces,
                    NodeArray& pressure) const {
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

int FeltStep::choose_pressures(const Loops& loops, const LapStarts& starts, const CommonLoop& loop,
                               int pieces, const PlayBounds& bounds, NodeArray& pressure) {
  loop_ = loop;
  take_points(loops, starts, pieces);
  fit(pressure);
  begin();
  const bool moved = from_ == From::MovedPoints;
  float fit_cost = 0.0F;
  if (!moved) {
    fit_cost = problem_.keep_loudness(fitted_);
    wanted_ = problem_.loudness();
  }
  const auto cost = [&](std::span<const float> root, std::span<float> gradient) {
    const float value = problem_.evaluate(root);
    problem_.gradient(root, gradient);
    return moved ? value + rise_cost(points(), bounds, pieces, root, gradient, {}, {}) : value;
  };
  int evaluations = moved ? 1 : 2;
  // std::function holds a reference without allocating
  if (descent_.begin(std::ref(cost), root_) > fit_cost && from_ == From::LastPlan) {
    // a path that has changed is not what the last plan's changes were for
    last_.clear();
    from_ = From::FitAgain;
    begin();
    descent_.begin(std::ref(cost), root_);
    ++evaluations;
  }
  const Effort& effort = kChoosing[static_cast<std::size_t>(from_)];
  evaluations += descent_.run(std::ref(cost), effort.first_step, effort.evaluations, root_);
  for (float& root : root_) root = std::abs(root);  // either sign stands for p
  // as loud as the fit, if its output suffices
  problem_.evaluate(root_);
  const FeltProblem::Loudness found = problem_.loudness();
  const float highest = *std::max_element(root_.begin(), root_.end());
  const float scale = std::min({wanted_.felt / found.felt, wanted_.output / found.output,
                                bounds.most[0] / (highest * highest)});
  for (float& root : root_) root *= std::sqrt(scale);
  for (std::size_t j = 0; j < node_.size(); ++j) pressure[node_[j]] = root_[j] * root_[j];
  remember(From::LastPlan);
  join(loops, starts, pieces, pressure);
  return evaluations;
}

/// (P21): the variables are √p, then x and y of all points in units of kPerUnit.
float FeltStep::moved_cost(const ShapeSettings& shape, const PlayBounds& bounds, int pieces,
                           std::span<const float> x, std::span<float> gradient) {
  const std::size_t n = node_.size();
  for (std::size_t j = 0; j < n; ++j) {
    x_[j] = loops_.x[node_[j]] = kPerUnit * x[n + j];
    y_[j] = loops_.y[node_[j]] = kPerUnit * x[2 * n + j];
  }
  problem_.set_points(points(), loop_);
  float value = problem_.evaluate(x.first(n));
  problem_.gradient(x.first(n), gradient.first(n));
  value += problem_.slide(gradient.subspan(n, n), gradient.subspan(2 * n, n));
  value += rise_cost(points(), bounds, pieces, x.first(n), gradient.first(n),
                     gradient.subspan(n, n), gradient.subspan(2 * n, n));
  pairs_.update(loops_, shape);
  shape_x_.fill(0.0F);
  shape_y_.fill(0.0F);
  const float share = kUnitArea / problem_.square();
  value += share * shape_cost(loops_, shape, pairs_.list(), shape_x_, shape_y_);
  for (std::size_t j = 0; j < n; ++j) {
    gradient[n + j] = kPerUnit * (gradient[n + j] + share * shape_x_[node_[j]]);
    gradient[2 * n + j] = kPerUnit * (gradient[2 * n + j] + share * shape_y_[node_[j]]);
  }
  return value;
}

int FeltStep::move_points(const LapStarts& starts, const CommonLoop& loop,
                          const ShapeSettings& shape, const PlayBounds& bounds, int pieces,
                          const NodeArray& pressure, Loops& loops) {
  loop_ = loop;
  take_points(loops, starts, 1);
  fit(pressure);
  begin();
  const bool again = from_ == From::MovedPoints;
  if (!again) {
    problem_.keep_loudness(fitted_);
    wanted_ = problem_.loudness();
  }
  loops_ = loops;
  pairs_.clear();
  const std::size_t n = node_.size();
  variables_.resize(3 * n);
  for (std::size_t j = 0; j < n; ++j) {
    variables_[j] = root_[j];
    variables_[n + j] = x_[j] / kPerUnit;
    variables_[2 * n + j] = y_[j] / kPerUnit;
  }
  const auto cost = [&](std::span<const float> x, std::span<float> gradient) {
    return moved_cost(shape, bounds, pieces, x, gradient);
  };
  const Effort& effort = again ? kMovingAgain : kMoving;
  descent_.begin(std::ref(cost), variables_);
  const int evaluations =
      descent_.run(std::ref(cost), effort.first_step, effort.evaluations, variables_);
  for (std::size_t j = 0; j < n; ++j) {
    root_[j] = std::abs(variables_[j]);
    x_[j] = loops.x[node_[j]] = kPerUnit * variables_[n + j];
    y_[j] = loops.y[node_[j]] = kPerUnit * variables_[2 * n + j];
  }
  remember(From::MovedPoints);
  return again ? evaluations : evaluations + 1;
}

}  // namespace prostm::planning
