#pragma once
/// The tests of a plan, in its order.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "prostm/study/analysis/answer.hpp"
#include "prostm/study/analysis/effects.hpp"
#include "prostm/study/plan/study_plan.hpp"

namespace prostm {

/// One group of a planned comparison.
struct PlannedGroup {
  int participants = 0;
  std::optional<double> mean;  ///< of the participants' values
};

struct PlannedResult {
  PlannedComparison of;
  Groups groups = Groups::Between;  ///< Within also for a comparison with chance
  PlannedGroup first, second;       ///< second: chance, if the plan has one method
  /// The planned test: t with its degrees of freedom, or the difference of means with 0. Nothing
  /// if there are too few values, or values do not vary.
  std::optional<TestResult> test;
  double corrected_p = 1.0;  ///< by the plan's correction; a missing test counts as p = 1
  bool significant = false;
  std::optional<Estimate> difference, effect;
  std::optional<double> bayes_factor;
  std::optional<Equivalence> equal;
};

struct ConfirmatoryResults {
  std::vector<PlannedResult> results;
  int participants = 0;               ///< with any value
  std::vector<std::string> left_out;  ///< a sentence for each rule that left something out
};

/// A participant's session, for the rules of exclusion.
struct SessionFacts {
  std::string participant;
  bool finished = true;
  bool passed_practice = true;  ///< of all methods
  double wrong_checks = 0.0;    ///< share of wrong answers to catch and attention trials
};

/// Runs the plan's tests. @param trials all trials, as read. @param sessions those to which a rule
/// may apply; participants without one are kept. @param seed for permutation tests of many
/// participants.
/// @throws InputError: no answer is left.
ConfirmatoryResults run_plan(const StudyPlan& plan, std::span<const Answer> trials,
                             std::span<const SessionFacts> sessions, std::uint64_t seed);

}  // namespace prostm
