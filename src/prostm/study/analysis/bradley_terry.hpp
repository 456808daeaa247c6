#pragma once
/// Paired comparisons of several stimuli: abilities by Bradley and Terry's model.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "prostm/study/task/statistics.hpp"

namespace prostm {

/// One comparison: two stimuli, and the preferred one.
struct PairedComparison {
  std::string participant;  ///< empty if unknown
  std::string a, b;
  enum class Preferred : std::uint8_t { A, B, Neither } preferred = Preferred::A;
};

/// The ability of a stimulus.
struct StimulusAbility {
  std::string stimulus;
  int comparisons = 0;
  double preferred = 0.0;  ///< times that it was preferred; a tie counts half
  double ability = 0.0;    ///< log-odds; those of all stimuli sum to 0
  double error = 0.0;      ///< standard error
  Interval interval;
};

/// Two stimuli under the model.
struct AbilityDifference {
  std::string first, second;
  int comparisons = 0;      ///< of these two
  double preferred = 0.0;   ///< times that the second was preferred
  double difference = 0.0;  ///< ability of the second minus that of the first
  double error = 0.0;
  Interval interval;
  double share = 0.5;  ///< the second is preferred with this probability
  double p = 1.0;      ///< Wald's test that abilities are equal
  double holm_p = 1.0;
};

struct BradleyTerry {
  std::size_t comparisons = 0, ties = 0;
  std::vector<std::string> participants;
  std::vector<StimulusAbility> stimuli;  ///< in order of first appearance
  std::vector<AbilityDifference> differences;
  /// Deviance from the model in which each pair has its own probability; nothing if there are no
  /// more pairs than abilities.
  std::optional<TestResult> misfit;
  double level = 0.95;
};

/// Fits P(b is preferred to a) = 1 / (1 + exp(ability of a − ability of b)) by maximum likelihood
/// (Newton), as if comparisons were independent (Y12). Intervals are Wald's, from the information.
/// A tie counts as half a preference for each. @param level of confidence, 0..1.
/// @throws InputError: no comparison; a stimulus compared with itself; two sets of stimuli with no
/// preference of one over the other, so that abilities are infinite or unrelated.
BradleyTerry fit_bradley_terry(std::span<const PairedComparison> comparisons, double level = 0.95);

/// Describes the results in plain words.
std::string in_words(const BradleyTerry& fit);

}  // namespace prostm
