#pragma once
/// Quality and speed of every planner on every sequence, all measured in turn in one run.

#include <array>
#include <string>
#include <vector>

#include "planner/contenders.hpp"
#include "planner/sequences.hpp"
#include "planner/violations.hpp"
#include "prostm/core/distribution.hpp"
#include "prostm/score/disturbance.hpp"
#include "prostm/score/score.hpp"
#include "report.hpp"

namespace prostm::bench {

struct QualityOptions {
  int frames = 20;  ///< scored frames per sequence
  int seeds = 20;   ///< number of seeds of the textbook planner
};

/// Stage times of Table I [µs].
inline constexpr int kStages = 7;
struct StageTimes {
  std::array<Distribution, kStages> stage;
  void add(const PlanStats& stats);
  Summary total() const { return stage[kStages - 1].summary(); }
};

/// One planner on one sequence. Vectors have one entry per scored frame.
struct Outcome {
  std::string name;
  bool warm = false;
  StageTimes times;
  std::vector<Metrics> metrics;
  std::vector<std::vector<Metrics>> disturbed;  ///< by disturbance
  Violations violations;
  int controls_lost = 0, controls = 0;  ///< controls that lost in every metric, and all controls
};

/// All planners on one sequence.
struct SequenceOutcome {
  std::string name;
  std::vector<int> frames;        ///< the scored frames
  Outcome textbook;               ///< the median of each metric over the seeds
  Outcome tuned;                  ///< the same with the weights of least RMSE on this sequence
  std::string tuned_weights;      ///< those weights
  std::vector<Outcome> planners;  ///< the first is paper-valid
  std::vector<Control> controls;  ///< means over the scored frames
};

/// @param other a target of another kind, for the control "paths of another target".
SequenceOutcome measure(const Sequence& sequence, const TargetField& other,
                        std::vector<Contender>& contenders, const QualityOptions& options);

/// Prints a sequence's tables.
void print(const SequenceOutcome& outcome);
/// Prints means over all sequences, the share of disturbances survived, and violations.
void print_summary(const std::vector<SequenceOutcome>& outcomes);
/// Appends times and errors of each planner, with the textbook's as the baseline.
void append_rows(const std::vector<SequenceOutcome>& outcomes, std::vector<Row>& rows);

/// Adds `share` of each metric to that of `sum`.
void add_share(const Metrics& more, double share, Metrics& sum);

}  // namespace prostm::bench
