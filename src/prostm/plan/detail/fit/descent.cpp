#include "prostm/plan/detail/fit/descent.hpp"

#include <algorithm>
#include <cmath>

#include "prostm/core/units.hpp"

namespace prostm::planning {
namespace {

constexpr float kArmijo = 1e-4F;
constexpr float kLeastSlope = 1e-12F;  // directions flatter than this end the descent
constexpr float kLeastCurvature = 1e-6F;
constexpr int kHalvings = 12;         // shorter trials of a step before the memory is dropped
constexpr float kFirstStep = 1.5F;    // longest move of a sample before curvature is known [mm]
constexpr float kLongestStep = 6.0F;  // longest move of a sample in any step [mm]

// Curvature that the preconditioner assumes for a mode with q = 2 − 2 cos(2πf/N): the curvature of
// the error itself, and the share of the length weight that acts across a mode.
constexpr double kErrorCurvature = 0.15, kLengthShare = 0.3;

}  // namespace

Descent::Descent(std::size_t max_tiles, int samples, const FitSettings& settings)
    : settings_(settings), reconstruct_(fast_reconstruct()), scratch_(max_tiles) {
  const double segment = static_cast<double>(settings.shape.most_length[0]) / samples;  // [mm]
  for (int d = 0; d <= samples / 2; ++d) {
    double tap = 0.0;
    for (int f = 0; f < samples; ++f) {
      const double angle = 2.0 * kPi * f / samples, q = 2.0 - 2.0 * std::cos(angle);
      const double curvature =
          kErrorCurvature +
          2.0 * kLengthShare * static_cast<double>(settings.shape.weight_length) * q +
          2.0 * static_cast<double>(settings.shape.weight_bending) / (segment * segment) * q * q;
      tap += std::cos(angle * d) / curvature;
    }
    taps_[static_cast<std::size_t>(d)] = static_cast<float>(tap / samples);
  }
  // with an even number of samples, the last tap is its own mirror image
  if (samples % 2 == 0) taps_[static_cast<std::size_t>(samples / 2)] *= 0.5F;
}

void Descent::evaluate(const CellTiles& cells, Fit& fit) {
  pairs_.clear();
  evaluate_near(cells, fit);
}

/// Same as evaluate(), for paths near those of the previous evaluation.
void Descent::evaluate_near(const CellTiles& cells, Fit& fit) {
  pairs_.update(fit.loops, settings_.shape);
  reconstruct_(cells, fit.loops, settings_.reconstruction, Wanted::PressuresAndGradient, scratch_,
               fit.reconstruction);
  fit.cost = fit.reconstruction.error + shape_cost(fit.loops, settings_.shape, pairs_.list(),
                                                   fit.reconstruction.gradient_x,
                                                   fit.reconstruction.gradient_y);
}

void Descent::solve(const CellTiles& cells, Fit& fit) {
  reconstruct_(cells, fit.loops, settings_.reconstruction, Wanted::Pressures, scratch_,
               fit.reconstruction);
}

struct Descent::Operations {
  const Loops& loops;
  const decltype(Descent::taps_)& taps;

  float dot(const Plane& a, const Plane& b) const {
    // four partial sums: a fixed order that vectorises
    std::array<float, 4> sum{};
    for (std::size_t i = 0; i < loops.nodes(); i += 4) {
      for (std::size_t k = 0; k < 4; ++k)
        sum[k] += a.x[i + k] * b.x[i + k] + a.y[i + k] * b.y[i + k];
    }
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
  }
  void add(Plane& v, float factor, const Plane& w) const {
    for (std::size_t i = 0; i < loops.nodes(); ++i) {
      v.x[i] += factor * w.x[i];
      v.y[i] += factor * w.y[i];
    }
  }
  void scale(Plane& v, float factor) const {
    for (std::size_t i = 0; i < loops.nodes(); ++i) {
      v.x[i] *= factor;
      v.y[i] *= factor;
    }
  }
  /// A circulant along each path.
  void precondition(Plane& v) const {
    const std::size_t n = loops.nodes(), lanes = static_cast<std::size_t>(loops.lanes);
    const std::size_t half = static_cast<std::size_t>(loops.samples) / 2;
    alignas(64) std::array<float, 3 * kMaxLoopNodes> around;
    for (NodeArray* const values : {&v.x, &v.y}) {
      for (std::size_t copy = 0; copy < 3; ++copy) {
        std::copy_n(values->begin(), n, around.begin() + static_cast<std::ptrdiff_t>(copy * n));
      }
      const float* const centre = around.data() + n;
      for (std::size_t i = 0; i < n; ++i) (*values)[i] = taps[0] * centre[i];
      for (std::size_t d = 1; d <= half; ++d) {
        const float* const left = centre - d * lanes;
        const float* const right = centre + d * lanes;
        for (std::size_t i = 0; i < n; ++i) (*values)[i] += taps[d] * (left[i] + right[i]);
      }
    }
  }
};

void Descent::find_direction(const Loops& loops, const Reconstruction& at) {
  for (std::size_t i = 0; i < loops.nodes(); ++i) {
    direction_.x[i] = -at.gradient_x[i];
    direction_.y[i] = -at.gradient_y[i];
  }
  memory_.find_direction(Operations{loops, taps_}, direction_);
}

void Descent::remember(const Fit& from, const Fit& to) {
  const Operations operations{from.loops, taps_};
  Plane &step = memory_.step(), &change = memory_.change();
  for (std::size_t i = 0; i < from.loops.nodes(); ++i) {
    step.x[i] = to.loops.x[i] - from.loops.x[i];
    step.y[i] = to.loops.y[i] - from.loops.y[i];
    change.x[i] = to.reconstruction.gradient_x[i] - from.reconstruction.gradient_x[i];
    change.y[i] = to.reconstruction.gradient_y[i] - from.reconstruction.gradient_y[i];
  }
  // a stored step of negative curvature would make the direction point uphill
  const float curvature = operations.dot(step, change);
  if (curvature <= kLeastCurvature * operations.dot(change, change)) return;
  Plane& scaled = direction_;
  std::copy_n(change.x.begin(), from.loops.nodes(), scaled.x.begin());
  std::copy_n(change.y.begin(), from.loops.nodes(), scaled.y.begin());
  operations.precondition(scaled);
  memory_.keep(curvature, curvature / operations.dot(change, scaled));
}

namespace {

/// Copies the nodes in use; both have the same shape.
void copy(const Fit& from, Fit& to) {
  const auto n = static_cast<std::ptrdiff_t>(from.loops.nodes());
  const Reconstruction& source = from.reconstruction;
  std::copy_n(from.loops.x.begin(), n, to.loops.x.begin());
  std::copy_n(from.loops.y.begin(), n, to.loops.y.begin());
  std::copy_n(source.pressure.begin(), n, to.reconstruction.pressure.begin());
  std::copy_n(source.gradient_x.begin(), n, to.reconstruction.gradient_x.begin());
  std::copy_n(source.gradient_y.begin(), n, to.reconstruction.gradient_y.begin());
  to.reconstruction.error = source.error;
  to.cost = from.cost;
}

}  // namespace

int Descent::run(const CellTiles& cells, Fit& fit, int evaluations, const Deadline& deadline) {
  memory_.forget();
  evaluate(cells, fit);
  int used = 1;
  trial_.loops.samples = fit.loops.samples;
  trial_.loops.paths = fit.loops.paths;
  trial_.loops.lanes = fit.loops.lanes;
  const auto may_go_on = [&] { return used < evaluations && !deadline.has_passed(); };
  while (may_go_on()) {
    find_direction(fit.loops, fit.reconstruction);
    float slope = 0.0F, longest2 = 0.0F;
    for (std::size_t i = 0; i < fit.loops.nodes(); ++i) {
      slope += direction_.x[i] * fit.reconstruction.gradient_x[i] +
               direction_.y[i] * fit.reconstruction.gradient_y[i];
      longest2 =
          std::max(longest2, direction_.x[i] * direction_.x[i] + direction_.y[i] * direction_.y[i]);
    }
    if (!(slope < -kLeastSlope)) {
      if (memory_.is_empty()) return used;
      memory_.forget();
      continue;
    }
    const float most = memory_.is_empty() ? kFirstStep : kLongestStep;
    float length = std::min(1.0F, most / std::sqrt(longest2));
    if (memory_.is_empty()) length = most / std::sqrt(longest2);
    bool lower = false;
    for (int halving = 0; halving <= kHalvings && may_go_on(); ++halving, length *= 0.4F) {
      for (std::size_t i = 0; i < fit.loops.nodes(); ++i) {
        trial_.loops.x[i] = fit.loops.x[i] + length * direction_.x[i];
        trial_.loops.y[i] = fit.loops.y[i] + length * direction_.y[i];
      }
      evaluate_near(cells, trial_);
      ++used;
      lower = trial_.cost <= fit.cost + kArmijo * length * slope;
      if (lower) break;
    }
    if (!lower) {
      if (memory_.is_empty()) return used;
      memory_.forget();
      continue;
    }
    remember(fit, trial_);
    copy(trial_, fit);
  }
  return used;
}

}  // namespace prostm::planning
