#include <algorithm>
#include <array>
#include <cmath>

#include "prostm/plan/quasi_static/closest_point.hpp"
#include "prostm/plan/quasi_static/quasi_static.hpp"
#include "prostm/plan/quasi_static/quasi_static_pressure.hpp"
#include "prostm/score/detail/bands.hpp"
#include "prostm/score/detail/scorer.hpp"
#include "prostm/score/pooled.hpp"

namespace prostm {
namespace {

constexpr double kSpillShare = 0.1;  // share of max p* below which a cell counts as without target

constexpr std::size_t kBandCells = 4096;  // cells summed by one thread at a time

/// Target and rendered field on the skin, both over max p*.
struct SkinValues {
  const std::vector<double>& target;
  const std::vector<double>& rendered;
};

/// Comparison of two fields on the skin; see Metrics.
struct Comparison {
  double rmse = 0.0, correlation = 0.0, skill = 0.0, overlap = 0.0, spill = 0.0;
};

/// Computes sums over cells. @param add adds a cell's target and rendered value to them.
template <std::size_t kSums, class Add>
std::array<double, kSums> sums_of(const SkinValues& v, WorkerPool* pool, const Add& add) {
  const auto band = [&](std::size_t first, std::size_t end) {
    std::array<double, kSums> sums{};
    for (std::size_t i = first; i < end; ++i) add(sums, v.target[i], v.rendered[i]);
    return sums;
  };
  return sums_of_bands<kSums>(pool, v.target.size(), band, kBandCells);
}

Comparison compare(const SkinValues& v, WorkerPool* pool) {
  const auto [target, rendered, product, square, errors, outside] =
      sums_of<6>(v, pool, [](auto& sums, double t, double r) {
        sums[0] += t;
        sums[1] += r;
        sums[2] += t * r;
        sums[3] += r * r;
        sums[4] += (r - t) * (r - t);
        if (t < kSpillShare) sums[5] += r;
      });
  const auto cells = static_cast<double>(v.target.size());
  const double gain = square > 0.0 ? product / square : 0.0;  // minimises Σ (p* − g p̂)²
  const double target_mean = target / cells, rendered_mean = rendered / cells;
  const auto [spread, rendered_spread, joint_spread, unexplained, shared, joint] =
      sums_of<6>(v, pool, [=](auto& sums, double t, double r) {
        const double dt = t - target_mean, dr = r - rendered_mean, rest = t - gain * r;
        sums[0] += dt * dt;
        sums[1] += dr * dr;
        sums[2] += dt * dr;
        sums[3] += rest * rest;
        sums[4] += std::min(t, gain * r);
        sums[5] += std::max(t, gain * r);
      });
  Comparison out;
  out.rmse = std::sqrt(errors / cells);
  const double spreads = std::sqrt(spread * rendered_spread);
  if (spreads > 0.0) out.correlation = joint_spread / spreads;
  if (spread > 0.0) out.skill = 1.0 - unexplained / spread;
  if (joint > 0.0) out.overlap = shared / joint;
  if (rendered > 0.0) out.spill = outside / rendered;
  return out;
}

/// (Q3) from the closest point of each cell.
double covered_share(const TargetField& target, const std::vector<ClosestPoint>& nearest,
                     double sigma, WorkerPool* pool) {
  const auto band = [&](std::size_t first, std::size_t end) {
    std::array<double, 2> sums{};
    for (std::size_t i = first; i < end; ++i) {
      if (target.skin[i] == 0) continue;
      sums[0] += target.pressure[i];
      if (nearest[i].distance2 <= sigma * sigma) sums[1] += target.pressure[i];
    }
    return sums;
  };
  const auto [all, covered] = sums_of_bands<2>(pool, target.size(), band, kBandCells);
  return covered / all;
}

}  // namespace

std::vector<ClosestPoint> closest_points(const TargetField& raster, const Plan& plan, int patch,
                                         WorkerPool* pool) {
  const PathSegments segments(plan, patch);
  if (segments.empty()) return {};
  std::vector<ClosestPoint> out(raster.size());
  for_bands(pool, static_cast<std::size_t>(raster.rows), [&](std::size_t first, std::size_t end) {
    PathSegments own = segments;  // a copy per band, since a search updates its state
    own.for_closest(raster, static_cast<int>(first), static_cast<int>(end),
                    [&](std::size_t cell, const ClosestPoint& point) { out[cell] = point; });
  });
  return out;
}

double plan_coverage(const TargetField& target, const Plan& plan, int patch, double sigma) {
  if (!(max_pressure(target) > 0.0)) return 0.0;
  const std::vector<ClosestPoint> nearest = closest_points(target, plan, patch);
  return nearest.empty() ? 0.0 : covered_share(target, nearest, sigma, nullptr);
}

Scorer::Scorer(const TargetField& target, WorkerPool* pool)
    : target_(target), maximum_(max_pressure(target)), pool_(pool), blur_(target, pool) {
  if (!(maximum_ > 0.0)) return;
  for (std::size_t i = 0; i < target.size(); ++i) {
    if (target.skin[i] != 0) cells_.push_back(i);
  }
  share_ = on_skin(target.pressure);
  blurred_ = on_skin(blur_.of(target.pressure));
}

std::vector<double> Scorer::on_skin(const std::vector<double>& field) const {
  std::vector<double> values(cells_.size());
  const auto band = [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) values[i] = field[cells_[i]] / maximum_;
  };
  for_bands(pool_, cells_.size(), band, kBandCells);
  return values;
}

Metrics Scorer::field(const std::vector<double>& rendered, double coverage) const {
  Metrics m;
  if (!(maximum_ > 0.0)) return m;
  const Comparison sharp = compare({share_, on_skin(rendered)}, pool_);
  m.rmse = sharp.rmse;
  m.correlation = sharp.correlation;
  m.coverage = coverage;
  m.skill_0 = sharp.skill;
  m.overlap = sharp.overlap;
  m.spill = sharp.spill;
  // the same skill after blurring detail finer than b
  m.skill_8 = compare({blurred_, on_skin(blur_.of(rendered))}, pool_).skill;
  return m;
}

Metrics Scorer::plan(const Plan& plan, int patch, double sigma, const GainLaw& gain,
                     const SegmentPressures* instead) const {
  if (!(maximum_ > 0.0)) return {};
  const std::vector<ClosestPoint> nearest = closest_points(target_, plan, patch, pool_);
  if (nearest.empty()) return field(std::vector<double>(target_.size(), 0.0), 0.0);
  return this->plan(plan, patch, sigma, gain, nearest, instead);
}

Metrics Scorer::plan(const Plan& plan, int patch, double sigma, const GainLaw& gain,
                     const std::vector<ClosestPoint>& nearest,
                     const SegmentPressures* instead) const {
  const QuasiStaticPressure pressure(plan, patch, sigma, gain, instead);
  std::vector<double> rendered(target_.size());
  const auto cols = static_cast<std::size_t>(target_.cols);
  for_bands(pool_, static_cast<std::size_t>(target_.rows), [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first * cols; i < end * cols; ++i) rendered[i] = pressure.at(nearest[i]);
  });
  return field(rendered, covered_share(target_, nearest, sigma, pool_));
}

Metrics score_field(const TargetField& target, const std::vector<double>& rendered,
                    double coverage) {
  return Scorer(target).field(rendered, coverage);
}

Metrics score_plan(const TargetField& target, const Plan& plan, int patch, double sigma,
                   const GainLaw& gain, const SegmentPressures* instead) {
  return Scorer(target).plan(plan, patch, sigma, gain, instead);
}

Metrics score_plan(const TargetField& target, const Plan& plan, int patch, double sigma,
                   const GainLaw& gain, const SegmentPressures* instead, WorkerPool& pool) {
  return Scorer(target, &pool).plan(plan, patch, sigma, gain, instead);
}

double weighted_rmse(const TargetField& target, const Plan& plan, int patch, double sigma,
                     const GainLaw& gain, const SegmentPressures* instead) {
  const double maximum = max_pressure(target), largest = max_weight(target);
  if (!(maximum > 0.0)) return 0.0;
  std::vector<double> rendered(target.size());
  quasi_static_field(plan, patch, target, sigma, gain, rendered, instead);
  double sum = 0.0, weights = 0.0;
  for (std::size_t i = 0; i < target.size(); ++i) {
    if (target.skin[i] == 0) continue;
    const double w = target.weight[i] / largest,
                 error = (rendered[i] - target.pressure[i]) / maximum;
    sum += w * error * error;
    weights += w;
  }
  return std::sqrt(sum / weights);
}

}  // namespace prostm
