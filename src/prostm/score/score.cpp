#include <algorithm>
#include <cmath>

#include "prostm/plan/closest_point.hpp"
#include "prostm/plan/quasi_static.hpp"
#include "prostm/plan/quasi_static_pressure.hpp"
#include "prostm/score/detail/bands.hpp"
#include "prostm/score/detail/scorer.hpp"
#include "prostm/score/pooled.hpp"

namespace prostm {
namespace {

constexpr double kSpillShare = 0.1;  // share of max p* below which nothing is to be felt

/// Target and rendered field on the skin, both over max p*.
struct SkinValues {
  const std::vector<double>& target;
  const std::vector<double>& rendered;
};

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

double mean(const std::vector<double>& a) {
  double sum = 0.0;
  for (const double v : a) sum += v;
  return a.empty() ? 0.0 : sum / static_cast<double>(a.size());
}

double squared_deviation(const std::vector<double>& a) {
  const double m = mean(a);
  double sum = 0.0;
  for (const double v : a) sum += (v - m) * (v - m);
  return sum;
}

/// The g that minimises Σ (target − g rendered)²; 0 if nothing is rendered.
double best_gain(const SkinValues& v) {
  const double norm = dot(v.rendered, v.rendered);
  return norm > 0.0 ? dot(v.target, v.rendered) / norm : 0.0;
}

double rmse(const SkinValues& v) {
  double sum = 0.0;
  for (std::size_t i = 0; i < v.target.size(); ++i) {
    sum += (v.rendered[i] - v.target[i]) * (v.rendered[i] - v.target[i]);
  }
  return v.target.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(v.target.size()));
}

double correlation(const SkinValues& v) {
  const double spread = std::sqrt(squared_deviation(v.target) * squared_deviation(v.rendered));
  if (!(spread > 0.0)) return 0.0;
  const double target_mean = mean(v.target), rendered_mean = mean(v.rendered);
  double sum = 0.0;
  for (std::size_t i = 0; i < v.target.size(); ++i) {
    sum += (v.target[i] - target_mean) * (v.rendered[i] - rendered_mean);
  }
  return sum / spread;
}

double skill(const SkinValues& v) {
  const double spread = squared_deviation(v.target);
  if (!(spread > 0.0)) return 0.0;
  const double g = best_gain(v);
  double sum = 0.0;
  for (std::size_t i = 0; i < v.target.size(); ++i) {
    sum += (v.target[i] - g * v.rendered[i]) * (v.target[i] - g * v.rendered[i]);
  }
  return 1.0 - sum / spread;
}

double overlap(const SkinValues& v) {
  const double g = best_gain(v);
  double shared = 0.0, joint = 0.0;
  for (std::size_t i = 0; i < v.target.size(); ++i) {
    shared += std::min(v.target[i], g * v.rendered[i]);
    joint += std::max(v.target[i], g * v.rendered[i]);
  }
  return joint > 0.0 ? shared / joint : 0.0;
}

double spill(const SkinValues& v) {
  double outside = 0.0, all = 0.0;
  for (std::size_t i = 0; i < v.target.size(); ++i) {
    all += v.rendered[i];
    if (v.target[i] < kSpillShare) outside += v.rendered[i];
  }
  return all > 0.0 ? outside / all : 0.0;
}

std::vector<double> on_skin(const TargetField& target, const std::vector<double>& field) {
  std::vector<double> values;
  values.reserve(field.size());
  for (std::size_t i = 0; i < field.size(); ++i) {
    if (target.skin[i] != 0) values.push_back(field[i]);
  }
  return values;
}

/// (Q3) from the closest point of each cell.
double covered_share(const TargetField& target, const std::vector<ClosestPoint>& nearest,
                     double maximum, double sigma) {
  double covered = 0.0, all = 0.0;
  for (std::size_t i = 0; i < target.size(); ++i) {
    if (target.skin[i] == 0) continue;
    const double p = target.pressure[i] / maximum;
    all += p;
    if (nearest[i].distance2 <= sigma * sigma) covered += p;
  }
  return covered / all;
}

}  // namespace

std::vector<ClosestPoint> closest_points(const TargetField& raster, const Plan& plan, int patch,
                                         WorkerPool* pool) {
  const PathSegments segments(plan, patch);
  if (segments.empty()) return {};
  std::vector<ClosestPoint> out(raster.size());
  for_bands(pool, static_cast<std::size_t>(raster.rows), [&](std::size_t first, std::size_t end) {
    PathSegments own = segments;  // it remembers the last search
    own.for_closest(raster, static_cast<int>(first), static_cast<int>(end),
                    [&](std::size_t cell, const ClosestPoint& point) { out[cell] = point; });
  });
  return out;
}

double plan_coverage(const TargetField& target, const Plan& plan, int patch, double sigma) {
  const double maximum = max_pressure(target);
  if (!(maximum > 0.0)) return 0.0;
  const std::vector<ClosestPoint> nearest = closest_points(target, plan, patch);
  return nearest.empty() ? 0.0 : covered_share(target, nearest, maximum, sigma);
}

Scorer::Scorer(const TargetField& target, WorkerPool* pool)
    : target_(target), maximum_(max_pressure(target)), pool_(pool), blur_(target, pool) {
  if (!(maximum_ > 0.0)) return;
  std::vector<double> share(target.size());
  for (std::size_t i = 0; i < target.size(); ++i) share[i] = target.pressure[i] / maximum_;
  share_ = on_skin(target, share);
  blurred_ = on_skin(target, blur_.of(share));
}

Metrics Scorer::field(const std::vector<double>& rendered, double coverage) const {
  Metrics m;
  if (!(maximum_ > 0.0)) return m;
  std::vector<double> share(rendered.size());
  for (std::size_t i = 0; i < share.size(); ++i) share[i] = rendered[i] / maximum_;
  const std::vector<double> on = on_skin(target_, share),
                            blurred = on_skin(target_, blur_.of(share));
  const SkinValues v{share_, on};
  m.rmse = rmse(v);
  m.correlation = correlation(v);
  m.coverage = coverage;
  m.skill_0 = skill(v);
  m.overlap = overlap(v);
  m.spill = spill(v);
  // the same skill after detail finer than b is blurred away
  m.skill_8 = skill({blurred_, blurred});
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
  return field(rendered, covered_share(target_, nearest, maximum_, sigma));
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
