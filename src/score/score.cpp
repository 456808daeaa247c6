#include "score/score.hpp"

#include <algorithm>
#include <cmath>

#include "plan/closest_point.hpp"
#include "plan/quasi_static.hpp"

namespace prostm {
namespace {

constexpr double kBlur = 8.5e-3;     // b of skill_8 [m]
constexpr double kBlurReach = 4.0;   // the Gaussian is cut off at so many b
constexpr double kSpillShare = 0.1;  // of max p*: pressure below this is not to be felt

/// Target and rendered field on the skin, both over max p*.
struct SkinValues {
  std::vector<double> target, rendered;
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

/// g that minimises Σ (target − g rendered)²; 0 when nothing is rendered.
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

SkinValues on_skin(const TargetField& target, const std::vector<double>& rendered, double maximum) {
  SkinValues v;
  for (std::size_t i = 0; i < target.size(); ++i) {
    if (target.skin[i] == 0) continue;
    v.target.push_back(target.pressure[i] / maximum);
    v.rendered.push_back(rendered[i] / maximum);
  }
  return v;
}

/// One pass of a separable Gaussian along rows (stride 1) or columns.
std::vector<double> blur_along(const std::vector<double>& in, std::size_t lines,
                               std::size_t line_stride, std::size_t length, std::size_t stride,
                               const std::vector<double>& kernel) {
  std::vector<double> out(in.size(), 0.0);
  const auto reach = static_cast<std::ptrdiff_t>(kernel.size()) - 1;
  const auto n = static_cast<std::ptrdiff_t>(length);
  for (std::size_t line = 0; line < lines; ++line) {
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      double sum = 0.0;
      for (std::ptrdiff_t j = std::max<std::ptrdiff_t>(i - reach, 0);
           j <= std::min(i + reach, n - 1); ++j) {
        sum += kernel[static_cast<std::size_t>(std::abs(i - j))] *
               in[line * line_stride + static_cast<std::size_t>(j) * stride];
      }
      out[line * line_stride + static_cast<std::size_t>(i) * stride] = sum;
    }
  }
  return out;
}

/// Gaussian mean over the skin (Q5): blur of the field on skin over the blur of the skin itself.
std::vector<double> blur_within_skin(const TargetField& target, const std::vector<double>& field) {
  const auto rows = static_cast<std::size_t>(target.rows),
             cols = static_cast<std::size_t>(target.cols);
  const double reach = std::min(kBlurReach * kBlur / target.cell, static_cast<double>(rows + cols));
  std::vector<double> kernel(static_cast<std::size_t>(reach) + 1);
  for (std::size_t i = 0; i < kernel.size(); ++i) {
    const double d = static_cast<double>(i) * target.cell / kBlur;
    kernel[i] = std::exp(-0.5 * d * d);
  }
  const auto blur = [&](const std::vector<double>& in) {
    return blur_along(blur_along(in, rows, cols, cols, 1, kernel), cols, 1, rows, cols, kernel);
  };
  std::vector<double> masked(field.size()), skin(field.size());
  for (std::size_t i = 0; i < field.size(); ++i) {
    skin[i] = target.skin[i] != 0 ? 1.0 : 0.0;
    masked[i] = skin[i] * field[i];
  }
  const std::vector<double> sum = blur(masked), weight = blur(skin);
  for (std::size_t i = 0; i < field.size(); ++i)
    masked[i] = skin[i] > 0.0 ? sum[i] / weight[i] : 0.0;
  return masked;
}

}  // namespace

double plan_coverage(const TargetField& target, const Plan& plan, int patch, double sigma) {
  PathSegments segments(plan, patch);
  const double maximum = max_pressure(target);
  if (segments.empty() || !(maximum > 0.0)) return 0.0;
  double covered = 0.0, all = 0.0;
  for (int row = 0; row < target.rows; ++row) {
    for (int col = 0; col < target.cols; ++col) {
      const std::size_t i = target.index(row, col);
      if (target.skin[i] == 0) continue;
      const double p = target.pressure[i] / maximum;
      all += p;
      if (segments.closest(target.position(row, col)).distance2 <= sigma * sigma) covered += p;
    }
  }
  return covered / all;
}

Metrics score_field(const TargetField& target, const std::vector<double>& rendered,
                    double coverage) {
  Metrics m;
  const double maximum = max_pressure(target);
  if (!(maximum > 0.0)) return m;
  const SkinValues v = on_skin(target, rendered, maximum);
  m.rmse = rmse(v);
  m.correlation = correlation(v);
  m.coverage = coverage;
  m.skill_0 = skill(v);
  m.overlap = overlap(v);
  m.spill = spill(v);

  // the same skill on what is left when detail finer than b is blurred away
  std::vector<double> target_share(target.size()), rendered_share(target.size());
  for (std::size_t i = 0; i < target.size(); ++i) {
    target_share[i] = target.pressure[i] / maximum;
    rendered_share[i] = rendered[i] / maximum;
  }
  TargetField blurred = target;
  blurred.pressure = blur_within_skin(target, target_share);
  m.skill_8 = skill(on_skin(blurred, blur_within_skin(target, rendered_share), 1.0));
  return m;
}

Metrics score_plan(const TargetField& target, const Plan& plan, int patch, double sigma,
                   const GainLaw& gain) {
  if (!(max_pressure(target) > 0.0)) return {};
  std::vector<double> rendered(target.size());
  quasi_static_field(plan, patch, target, sigma, gain, rendered);
  return score_field(target, rendered, plan_coverage(target, plan, patch, sigma));
}

double weighted_rmse(const TargetField& target, const Plan& plan, int patch, double sigma,
                     const GainLaw& gain) {
  const double maximum = max_pressure(target), largest = max_weight(target);
  if (!(maximum > 0.0)) return 0.0;
  std::vector<double> rendered(target.size());
  quasi_static_field(plan, patch, target, sigma, gain, rendered);
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
