#pragma once
/// Adaptive procedures that find a threshold: they choose each level from the answers so far.
///
/// Higher levels are easier. A procedure does not depend on time, so it can be restored by giving
/// it the same answers again.

#include <cstdint>
#include <vector>

#include "prostm/core/random.hpp"
#include "prostm/study/protocol/level_range.hpp"
#include "prostm/study/task/psychometric.hpp"

namespace prostm {

struct UpDownSettings {
  double start = 0.8;
  double step = 0.08;    ///< downwards; doubled for the first `coarse` reversals
  double target = 0.75;  ///< share of right answers to converge to, 0..1
  int coarse = 2;        ///< reversals with the double step
  int reversals = 12;    ///< total reversals, after which it ends
  LevelRange range = {};
};

/// The weighted up-down method (Kaernbach, Percept. Psychophys. 49, 227 (1991)): a right answer
/// lowers the level by a step, a wrong one raises it by target/(1 − target) steps, so that the
/// steps cancel where the share of right answers is `target`.
class WeightedUpDown {
 public:
  /// @throws std::invalid_argument: a setting out of its bounds.
  explicit WeightedUpDown(const UpDownSettings& settings);

  double level() const { return level_; }
  void answer(bool right);
  bool is_done() const { return reversals_ >= settings_.reversals; }
  int reversals() const { return reversals_; }
  /// Mean of the levels after the coarse reversals; NaN before the first. (The mean of the
  /// reversals alone is biased if steps up and down differ.)
  double threshold() const;

 private:
  UpDownSettings settings_;
  double level_;
  int direction_ = 0;  // of the last step
  int reversals_ = 0;
  double sum_ = 0.0;  // of the levels after the coarse reversals
  int count_ = 0;
};

struct BayesianSettings {
  Psychometric shape{.threshold = 0.0, .slope = 20.0, .guess = 0.5, .lapse = 0.02};
  double expected = 0.5, spread = 0.25;  ///< mean and standard deviation of the prior
  int trials = 40;
  LevelRange range = {};
};

/// A Bayesian staircase like QUEST (Watson & Pelli, Percept. Psychophys. 33, 113 (1983)): each
/// answer updates the probability of each threshold, for a psychometric function of known shape;
/// the next level is the posterior mean.
class BayesianStaircase {
 public:
  /// @throws std::invalid_argument: a setting out of its bounds.
  explicit BayesianStaircase(const BayesianSettings& settings);

  double level() const;
  void answer(bool right) { answer(right, level()); }
  /// @param at the level that was presented, if it differs from level().
  void answer(bool right, double at);
  bool is_done() const { return answers_ >= settings_.trials; }
  double threshold() const;  ///< posterior mean
  double deviation() const;  ///< posterior standard deviation

 private:
  BayesianSettings settings_;
  std::vector<double> threshold_, probability_;
  int answers_ = 0;
};

struct AdjustmentSettings {
  double coarse = 0.05, fine = 0.01;  ///< steps of the coarse and the fine keys
  int repeats = 4;                    ///< half of them begin below the middle, half above
  double away = 0.3;  ///< smallest distance of a first level from the middle of the range
  std::uint64_t seed = 1;
  LevelRange range = {};
};

/// The method of adjustment: the participant tunes a level until two stimuli feel alike, several
/// times, starting from random levels alternately below and above, so that the effect of the first
/// level cancels.
class Adjustment {
 public:
  /// @throws std::invalid_argument: a setting out of its bounds.
  explicit Adjustment(const AdjustmentSettings& settings);

  double level() const { return level_; }
  /// @param steps upwards; negative: downwards.
  void tune(int steps, bool coarse);
  /// Accepts the current level and begins the next repeat.
  void accept() { accept(level_); }
  /// Accepts another level instead: the one that was presented, or one from a file.
  void accept(double level);
  bool is_done() const { return accepted_.size() >= static_cast<std::size_t>(settings_.repeats); }
  const std::vector<double>& accepted() const { return accepted_; }
  double result() const;  ///< their mean; NaN before the first

 private:
  void begin();

  AdjustmentSettings settings_;
  Random random_;
  double level_ = 0.0;
  std::vector<double> accepted_;
};

}  // namespace prostm
