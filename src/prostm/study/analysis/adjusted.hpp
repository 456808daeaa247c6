#pragma once
/// The levels at which stimuli felt alike, found by adjustment.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "prostm/study/analysis/scores.hpp"
#include "prostm/study/task/statistics.hpp"

namespace prostm {

/// Adjusted levels of one participant.
struct AdjustedBy {
  std::string participant;
  int adjustments = 0;
  double mean = 0.0;
  std::optional<double> deviation;  ///< standard deviation; nothing for a single adjustment
};

/// Adjusted levels of one method in one scene, in the unit of the setting.
struct AdjustedResult {
  std::string method, scene;
  std::vector<AdjustedBy> participants;  ///< sorted by name
  double mean = 0.0;                     ///< mean of the participants' means
  std::optional<double> deviation;       ///< of these means; nothing for a single participant
  std::optional<Interval> interval;      ///< of the mean, by Student's t over participants
};

/// Summarises adjustments by method and scene, in order of first appearance. @param level
/// confidence level of the intervals, 0..1. @pre each answer has a level.
std::vector<AdjustedResult> adjusted_levels(std::span<const Answer> answers, double level);

/// Describes the results in plain words.
std::string in_words(std::span<const AdjustedResult> results, double level);

}  // namespace prostm
