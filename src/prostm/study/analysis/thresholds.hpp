#pragma once
/// Thresholds of methods and participants, from answers at several levels.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "prostm/study/analysis/scores.hpp"
#include "prostm/study/task/psychometric.hpp"

namespace prostm {

/// A psychometric function of one method in one scene.
struct ThresholdResult {
  std::string method, scene;
  std::string participant;         ///< empty: all participants together
  std::vector<LevelScore> scores;  ///< ascending by level; answers at the same level are pooled
  std::optional<PsychometricFit> fit;
  NoFit no_fit = NoFit::TooFewLevels;     ///< where there is no fit
  std::optional<ThresholdBounds> bounds;  ///< where there is no fit, but bounds
};

/// Fits each method in each scene, first for all participants together, then for each participant
/// by name.
/// @pre each answer has a level; as fit_psychometric().
std::vector<ThresholdResult> fit_thresholds(std::span<const Answer> answers,
                                            const PsychometricSettings& settings);

/// Significant digits that resolve about a thousandth of the range of levels. @pre levels ascend.
int level_digits(std::span<const LevelScore> scores);

/// Describes why there is no fit, without a full stop. @param kind the kind of the answers.
std::string in_words(NoFit reason, AnswerKind kind);

/// Describes the bounds of a threshold: "1.2 to 1.4", "below 1.2", "above 1.4". @pre an end is
/// finite.
std::string bounds_text(const Interval& of, int digits);

}  // namespace prostm
