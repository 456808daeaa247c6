#include "prostm/plan/detail/fit/felt/felt_problem.hpp"

#include <algorithm>
#include <cmath>

#include "prostm/plan/detail/pressure_raster.hpp"

namespace prostm::planning {
namespace {

// Factor on the loudness to keep if points move, since an array reaches less in some places than
// (P20) assumes. It is divided by the pace of the loop, since slower focal points are felt less.
constexpr float kSpare = 1.05F;
constexpr double kLeastPace = 0.7;    // lower bound of the pace in that division
constexpr float kLeastShare = 1e-6F;  // lower bound of a point's share of a lap, as a divisor
// Share of the pressure that transducers at full output give to several focal points, where (P20)
// assumes all of it: (E|Σ_k e^{iφ_k}|)²/K for K waves of random phase, 0.81, 0.83, 0.81 and 0.80
// for K = 2, 3, 4 and 8.
constexpr float kSharedOutput = 0.81F;

}  // namespace

std::size_t most_felt_points(const PlanSettings& settings) {
  const int samples = settings.moved_samples();
  const bool halved = settings.felt_points && 2 * samples <= kMaxPathPoints;
  return static_cast<std::size_t>(settings.paths) *
         static_cast<std::size_t>(halved ? 2 * samples : samples);
}

FeltProblem::FeltProblem(const PlanSettings& settings, const FeltScope& scope)
    : weight_(static_cast<float>(settings.felt_weight)),
      moves_(settings.felt_points),
      skins_(scope.skins),
      tables_(scope.tables ? scope.tables : std::make_shared<FeltTables>()),
      cells_(scope.most_cells),
      loss_(scope.skins, scope.most_cells, most_felt_points(settings), FeltWeights(),
            settings.felt_points),
      envelope_(scope.most_cells) {
  const std::size_t most = most_felt_points(settings);
  sources_.reserve(most);
  paths_.reserve(kMaxPaths);
  for (auto* list : {&pressure_, &gradient_, &felt_gradient_, &by_time_, &by_share_})
    list->reserve(most);
}

void FeltProblem::set_target(const TargetField& target, double maximum, double sigma) {
  sigma_ = sigma;
  cells_.set(target, maximum);
  loss_.set_target(cells_);
  double square = 0.0;
  for (const FeltCells::Cell& cell : cells_.cells())
    square += cell.area * cell.pressure * cell.pressure;
  const auto skin = std::count(target.skin.begin(), target.skin.end(), std::uint8_t{1});
  const double cell = kMmPerMetre * target.cell;
  square_ = static_cast<float>(square * cell * cell * static_cast<double>(skin));
}

void FeltProblem::set_points(const StepPoints& points, const CommonLoop& loop) {
  first_ = first_felt_harmonic(loop.period);
  if (moves_) spare_ = kSpare / static_cast<float>(std::clamp(loop.pace, kLeastPace, 1.0));
  points_ = points;
  const auto n = static_cast<std::size_t>(points.samples), all = points.x.size();
  for (auto* list : {&pressure_, &gradient_, &felt_gradient_, &by_time_, &by_share_})
    list->resize(all);
  sources_.resize(all);
  paths_.resize(all / n);
  for (std::size_t k = 0; k < paths_.size(); ++k) {
    paths_[k].set(points.x.subspan(k * n, n), points.y.subspan(k * n, n), loop.laps[k]);
    paths_[k].sources(first_, std::span(sources_).subspan(k * n, n));
  }
  demand_.set(paths_, n);
  loss_.set_sources(tables_->of(sigma_, loop.period, skins_), sources_);
  if (weight_ < 1.0F)
    envelope_.set_points(cells_.cells(), points, static_cast<float>(kMmPerMetre * sigma_));
}

/// Sets pressure_ from √p, scaled to an output of 1, and output_ to the output before scaling,
/// (P20).
void FeltProblem::normalise(std::span<const float> root) {
  for (std::size_t j = 0; j < root.size(); ++j) pressure_[j] = root[j] * root[j];
  output_ = demand_.normalise(pressure_);
}

/// Blends the loss of the percept with that of the field of Eq. (1).
float FeltProblem::add_envelope(float felt) {
  if (weight_ >= 1.0F) return felt;
  return weight_ * felt + (1.0F - weight_) * envelope_.evaluate(loss_.rendering(), pressure_);
}

FeltRating FeltProblem::rating() {
  envelope_.set_points(cells_.cells(), points_, static_cast<float>(kMmPerMetre * sigma_));
  const std::span<const float> percept = loss_.percept(kNominalSkin);
  const float strength = *std::max_element(percept.begin(), percept.end());
  return {loss_.coarse_lack(), paths_.size() > 1 ? kSharedOutput * strength : strength,
          envelope_.spill(cells_.cells(), pressure_)};
}

float FeltProblem::evaluate(std::span<const float> root) {
  normalise(root);
  return add_envelope(loss_.evaluate(pressure_));
}

float FeltProblem::keep_loudness(std::span<const float> root) {
  normalise(root);
  return add_envelope(loss_.keep_loudness(pressure_, spare_));
}

void FeltProblem::gradient(std::span<const float> root, std::span<float> gradient) {
  loss_.gradient(felt_gradient_);
  for (std::size_t j = 0; j < root.size(); ++j) gradient_[j] = weight_ * felt_gradient_[j];
  if (weight_ < 1.0F) envelope_.add_gradient(1.0F - weight_, gradient_);
  // the cost does not depend on the output, so the gradient along the pressures is removed
  along_ = 0.0F;
  for (std::size_t j = 0; j < root.size(); ++j) along_ += gradient_[j] * pressure_[j];
  demand_.add_gradient(along_, gradient_);
  for (std::size_t j = 0; j < root.size(); ++j)
    gradient[j] = 2.0F * root[j] * gradient_[j] / output_;
}

float FeltProblem::slide(std::span<float> gradient_x, std::span<float> gradient_y) {
  loss_.turn(pressure_, first_, by_time_);
  loss_.slide(pressure_, gradient_x, gradient_y);
  const auto n = static_cast<std::size_t>(points_.samples);
  for (std::size_t j = 0; j < by_time_.size(); ++j) {
    const StepPath<float>& path = paths_[j / n];
    gradient_x[j] *= weight_;
    gradient_y[j] *= weight_;
    by_time_[j] *= weight_ / static_cast<float>(path.laps());
    // a point's share of a lap scales the effect of its pressure
    by_share_[j] =
        weight_ * felt_gradient_[j] * pressure_[j] / std::max(path.share(j % n), kLeastShare);
  }
  demand_.add_by_time(along_, pressure_, by_time_);
  const float near = demand_.near_cost(points_, gradient_x, gradient_y, by_time_);
  for (std::size_t k = 0; k < paths_.size(); ++k) {
    paths_[k].add_gradient(std::span(by_time_).subspan(k * n, n),
                           std::span(by_share_).subspan(k * n, n), gradient_x.subspan(k * n, n),
                           gradient_y.subspan(k * n, n));
  }
  if (weight_ < 1.0F)
    envelope_.add_slide(1.0F - weight_, points_, pressure_, gradient_x, gradient_y);
  return near;
}

}  // namespace prostm::planning
