#include "prostm/plan/detail/fit/felt/felt_problem.hpp"

#include <algorithm>
#include <cmath>

#include "prostm/plan/detail/pressure_raster.hpp"

namespace prostm::planning {
namespace {

constexpr float kNorm = 16.0F;  // exponent of the norm that stands for the largest

/// Points that move can make use of finer cells than pressures can.
std::size_t most_cells(const PlanSettings& settings) {
  return settings.felt_points ? kFinerFeltCells : kFeltCells;
}

/// x to the power of kNorm − 1.
float almost_norm(float x) {
  const float second = x * x, fourth = second * second, eighth = fourth * fourth;
  return eighth * fourth * second * x;
}

}  // namespace

std::size_t most_felt_points(const PlanSettings& settings) {
  const int samples = settings.preset == Preset::Best ? settings.fit_samples : settings.samples;
  return static_cast<std::size_t>(settings.paths) * static_cast<std::size_t>(samples);
}

FeltProblem::FeltProblem(const PlanSettings& settings)
    : weight_(static_cast<float>(settings.felt_weight)),
      cells_(most_cells(settings)),
      loss_(kFeltSkins, most_cells(settings), most_felt_points(settings), FeltWeights(),
            settings.felt_points),
      envelope_(most_cells(settings)) {
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
  loss_.set_sources(tables_.of(sigma_, loop.period), sources_);
  if (weight_ < 1.0F)
    envelope_.set_points(cells_.cells(), points, static_cast<float>(kMmPerMetre * sigma_));
}

/// Calls f(point, moment, share) for the points that are passed at each moment of a loop: one of
/// each path, or several of a path with laps, which share the moment.
template <class F>
void FeltProblem::for_moments(F&& f) const {
  const auto n = static_cast<std::size_t>(points_.samples);
  for (std::size_t k = 0; k < paths_.size(); ++k) {
    const auto laps = static_cast<std::size_t>(paths_[k].laps());
    const float share = 1.0F / static_cast<float>(laps);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = laps * i; j < laps * (i + 1); ++j) f(k * n + j % n, i, share);
    }
  }
}

/// Sets pressure_ from √p, and demand_: at each moment the pressure of all paths, which is what an
/// array must hold. Both are for an output of 1; output_ is the output that it was, (P20).
void FeltProblem::normalise(std::span<const float> root) {
  const auto n = static_cast<std::size_t>(points_.samples);
  const std::span<float> demand = std::span(demand_).first(n);
  std::fill(demand.begin(), demand.end(), 0.0F);
  for (std::size_t j = 0; j < root.size(); ++j) pressure_[j] = root[j] * root[j];
  for_moments([&](std::size_t point, std::size_t moment, float share) {
    demand[moment] += share * pressure_[point];
  });
  const float most = *std::max_element(demand.begin(), demand.end());
  float sum = 0.0F;
  for (const float d : demand) sum += almost_norm(d / most) * d / most;
  output_ = most * std::pow(sum, 1.0F / kNorm);
  for (float& p : pressure_) p /= output_;
  for (float& d : demand) d /= output_;
}

/// Blends what is felt with the field of Eq. (1).
float FeltProblem::add_envelope(float felt) {
  if (weight_ >= 1.0F) return felt;
  return weight_ * felt + (1.0F - weight_) * envelope_.evaluate(loss_.rendering(), pressure_);
}

float FeltProblem::evaluate(std::span<const float> root) {
  normalise(root);
  return add_envelope(loss_.evaluate(pressure_));
}

float FeltProblem::keep_loudness(std::span<const float> root) {
  normalise(root);
  return add_envelope(loss_.keep_loudness(pressure_));
}

void FeltProblem::gradient(std::span<const float> root, std::span<float> gradient) {
  loss_.gradient(felt_gradient_);
  for (std::size_t j = 0; j < root.size(); ++j) gradient_[j] = weight_ * felt_gradient_[j];
  if (weight_ < 1.0F) envelope_.add_gradient(1.0F - weight_, gradient_);
  // more output changes nothing
  float along = 0.0F;
  for (std::size_t j = 0; j < root.size(); ++j) along += gradient_[j] * pressure_[j];
  for_moments([&](std::size_t point, std::size_t moment, float share) {
    gradient_[point] -= along * share * almost_norm(demand_[moment]);
  });
  for (std::size_t j = 0; j < root.size(); ++j)
    gradient[j] = 2.0F * root[j] * gradient_[j] / output_;
}

void FeltProblem::slide(std::span<float> gradient_x, std::span<float> gradient_y) {
  // how much a point stands for scales its pressure
  loss_.turn(pressure_, first_, by_time_);
  loss_.slide(pressure_, gradient_x, gradient_y);
  const auto n = static_cast<std::size_t>(points_.samples);
  for (std::size_t k = 0; k < paths_.size(); ++k) {
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t j = k * n + i;
      by_time_[j] /= static_cast<float>(paths_[k].laps());
      by_share_[j] = felt_gradient_[j] * pressure_[j] / std::max(paths_[k].share(i), 1e-6F);
    }
    paths_[k].add_gradient(std::span(by_time_).subspan(k * n, n),
                           std::span(by_share_).subspan(k * n, n), gradient_x.subspan(k * n, n),
                           gradient_y.subspan(k * n, n));
  }
  for (std::size_t j = 0; j < gradient_x.size(); ++j) {
    gradient_x[j] *= weight_;
    gradient_y[j] *= weight_;
  }
  if (weight_ < 1.0F)
    envelope_.add_slide(1.0F - weight_, points_, pressure_, gradient_x, gradient_y);
}

}  // namespace prostm::planning
