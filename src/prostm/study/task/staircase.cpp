#include "prostm/study/task/staircase.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "prostm/core/require.hpp"

namespace prostm {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kMost = 1e6;  // largest size of a level, in any unit

void require_range(const LevelRange& range) {
  require_between("lowest level", range.low, -kMost, kMost);
  require_between("highest level", range.high, range.low + 1e-9, kMost);
}

double inside(const LevelRange& range, double level) {
  return std::clamp(level, range.low, range.high);
}

}  // namespace

WeightedUpDown::WeightedUpDown(const UpDownSettings& settings)
    : settings_(settings), level_(settings.start) {
  require_range(settings.range);
  require_between("start", settings.start, settings.range.low, settings.range.high);
  require_between("step", settings.step, 1e-9, settings.range.high - settings.range.low);
  require_between("target", settings.target, 0.05, 0.95);
  require_between("coarse reversals", settings.coarse, 0, 100);
  require_between("reversals", settings.reversals, settings.coarse + 2, 1000);
}

void WeightedUpDown::answer(bool right) {
  const int direction = right ? -1 : 1;
  if (direction_ != 0 && direction != direction_) ++reversals_;
  direction_ = direction;
  if (reversals_ >= settings_.coarse) {
    sum_ += level_;
    ++count_;
  }
  const double step = reversals_ < settings_.coarse ? 2.0 * settings_.step : settings_.step;
  const double up = step * settings_.target / (1.0 - settings_.target);
  level_ = inside(settings_.range, right ? level_ - step : level_ + up);
}

double WeightedUpDown::threshold() const {
  return count_ > 0 ? sum_ / count_ : kNoNumber;
}

BayesianStaircase::BayesianStaircase(const BayesianSettings& settings) : settings_(settings) {
  const LevelRange& range = settings.range;
  require_range(range);
  require_between("guess", settings.shape.guess, 0.0, 0.9);
  require_between("lapse", settings.shape.lapse, 0.0, 0.09);
  require_between("slope", settings.shape.slope, 1e-6, 1e9);
  require_between("expected threshold", settings.expected, range.low, range.high);
  require_between("spread", settings.spread, 1e-9, 2.0 * kMost);
  require_between("trials", settings.trials, 1, 10'000);
  // the threshold may lie beyond the levels, so the prior covers twice the range
  constexpr int kThresholds = 600;
  const double width = range.high - range.low;
  for (int i = 0; i <= kThresholds; ++i) {
    const double t = range.low + width * (2.0 * i / kThresholds - 0.5);
    const double off = (t - settings.expected) / settings.spread;
    threshold_.push_back(t);
    probability_.push_back(std::exp(-0.5 * std::min(off * off, 1e3)));
  }
}

double BayesianStaircase::threshold() const {
  double sum = 0.0, weighted = 0.0;
  for (std::size_t i = 0; i < threshold_.size(); ++i) {
    sum += probability_[i];
    weighted += probability_[i] * threshold_[i];
  }
  return weighted / sum;
}

double BayesianStaircase::deviation() const {
  const double middle = threshold();
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < threshold_.size(); ++i) {
    sum += probability_[i];
    squares += probability_[i] * (threshold_[i] - middle) * (threshold_[i] - middle);
  }
  return std::sqrt(squares / sum);
}

double BayesianStaircase::level() const {
  return inside(settings_.range, threshold());
}

void BayesianStaircase::answer(bool right, double at) {
  Psychometric shape = settings_.shape;
  for (std::size_t i = 0; i < threshold_.size(); ++i) {
    shape.threshold = threshold_[i];
    const double share = shape.at(at);
    probability_[i] *= right ? share : 1.0 - share;
  }
  const double most = *std::max_element(probability_.begin(), probability_.end());
  for (double& p : probability_) p /= most;  // avoids underflow after many answers
  ++answers_;
}

Adjustment::Adjustment(const AdjustmentSettings& settings)
    : settings_(settings), random_(settings.seed) {
  require_range(settings.range);
  const double width = settings.range.high - settings.range.low;
  require_between("fine step", settings.fine, 1e-9, width);
  require_between("coarse step", settings.coarse, settings.fine, width);
  require_between("repeats", settings.repeats, 1, 100);
  require_between("away", settings.away, 0.0, 0.5 * width);
  begin();
}

void Adjustment::begin() {
  const LevelRange& range = settings_.range;
  const double middle = 0.5 * (range.low + range.high);
  const bool below = accepted_.size() % 2 == 0;
  level_ = below ? random_.uniform(range.low, middle - settings_.away)
                 : random_.uniform(middle + settings_.away, range.high);
}

void Adjustment::tune(int steps, bool coarse) {
  level_ = inside(settings_.range, level_ + steps * (coarse ? settings_.coarse : settings_.fine));
}

void Adjustment::accept(double level) {
  accepted_.push_back(level);
  if (!is_done()) begin();
}

double Adjustment::result() const {
  if (accepted_.empty()) return kNoNumber;
  return std::accumulate(accepted_.begin(), accepted_.end(), 0.0) /
         static_cast<double>(accepted_.size());
}

}  // namespace prostm
