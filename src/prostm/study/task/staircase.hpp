#pragma once
/// Procedures that find a threshold while a participant answers: what level comes next.
///
/// A level is easier the higher it is. Each procedure is a state without a clock, so that it can be
/// stored after each answer and go on from there by giving it the same answers again.

#include <cstdint>
#include <vector>

#include "prostm/core/random.hpp"
#include "prostm/study/protocol/level_range.hpp"
#include "prostm/study/task/psychometric.hpp"

namespace prostm {

struct UpDownSettings {
  double start = 0.8;
  double step = 0.08;    ///< down, after the first reversals; twice as much before
  double target = 0.75;  ///< share of right answers that it converges to, 0..1
  int coarse = 2;        ///< reversals with the double step
  int reversals = 12;    ///< after which it ends
  LevelRange range = {};
};

/// The weighted up-down method (Kaernbach, Percept. Psychophys. 49, 227 (1991)): a right answer
/// lowers the level by a step, a wrong one raises it by target/(1 − target) of it, so that where
/// the target's share is right, steps cancel.
class WeightedUpDown {
 public:
  /// @throws std::invalid_argument: a setting out of its bounds.
  explicit WeightedUpDown(const UpDownSettings& settings);

  double level() const { return level_; }
  void answer(bool right);
  bool is_done() const { return reversals_ >= settings_.reversals; }
  int reversals() const { return reversals_; }
  /// The mean of the levels since the coarse reversals. (That of the reversals alone is off where
  /// steps up and down differ.) NaN before there are any.
  double threshold() const;

 private:
  UpDownSettings settings_;
  double level_;
  int direction_ = 0;  // of the last step
  int reversals_ = 0;
  double sum_ = 0.0;  // of the levels since the coarse reversals
  int count_ = 0;
};

struct BayesianSettings {
  Psychometric shape{.threshold = 0.0, .slope = 20.0, .guess = 0.5, .lapse = 0.02};
  double expected = 0.5, spread = 0.25;  ///< the prior's mean and standard deviation of thresholds
  int trials = 40;
  LevelRange range = {};
};

/// A Bayesian staircase as QUEST (Watson & Pelli, Percept. Psychophys. 33, 113 (1983)): the
/// probability of each threshold is updated after each answer, with a known shape; the next level
/// is the mean.
class BayesianStaircase {
 public:
  /// @throws std::invalid_argument: a setting out of its bounds.
  explicit BayesianStaircase(const BayesianSettings& settings);

  double level() const;
  void answer(bool right) { answer(right, level()); }
  /// @param at the level that was presented, where only some can be.
  void answer(bool right, double at);
  bool is_done() const { return answers_ >= settings_.trials; }
  double threshold() const;  ///< the mean of what is probable
  double deviation() const;  ///< its standard deviation

 private:
  BayesianSettings settings_;
  std::vector<double> threshold_, probability_;
  int answers_ = 0;
};

struct AdjustmentSettings {
  double coarse = 0.05, fine = 0.01;  ///< steps of the two kinds of keys
  int repeats = 4;                    ///< half of them from below, half from above
  double away = 0.3;                  ///< from the middle of the range, at least, that one begins
  std::uint64_t seed = 1;
  LevelRange range = {};
};

/// The method of adjustment: the participant tunes a level until two stimuli feel alike, several
/// times, from random levels below and above in turn, so that where one begins cancels.
class Adjustment {
 public:
  /// @throws std::invalid_argument: a setting out of its bounds.
  explicit Adjustment(const AdjustmentSettings& settings);

  double level() const { return level_; }
  /// @param steps up or, below 0, down.
  void tune(int steps, bool coarse);
  /// Takes the level and begins the next repeat.
  void accept() { accept(level_); }
  /// The same with another level: that which was presented, or that of a file.
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
