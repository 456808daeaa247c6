#pragma once
/// The levels at which stimuli felt alike, from adjustments.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "prostm/study/analysis/scores.hpp"
#include "prostm/study/task/statistics.hpp"

namespace prostm {

/// Those of one participant.
struct AdjustedBy {
  std::string participant;
  int adjustments = 0;
  double mean = 0.0;
  std::optional<double> deviation;  ///< standard deviation of them; nothing of a single one
};

/// Those of one method in one scene. Levels are in the unit of the setting.
struct AdjustedResult {
  std::string method, scene;
  std::vector<AdjustedBy> participants;  ///< by name
  double mean = 0.0;                     ///< of the participants' means
  std::optional<double> deviation;       ///< standard deviation of these; nothing of a single one
  std::optional<Interval> interval;      ///< of the mean, by Student's t over participants
};

/// Methods and scenes stand in the order in which the answers have them first. @param level of the
/// intervals, 0..1. @pre each answer has a level.
std::vector<AdjustedResult> adjusted_levels(std::span<const Answer> answers, double level);

/// In plain words.
std::string in_words(std::span<const AdjustedResult> results, double level);

}  // namespace prostm
