#pragma once
/// The conclusions that the answers of a study do and do not support.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "prostm/study/analysis/scores.hpp"
#include "prostm/study/analysis/thresholds.hpp"
#include "prostm/study/task/statistics.hpp"

namespace prostm {

struct AnalysisSettings {
  double chance = 0.5;     ///< share of right answers that guessing makes, 0..1
  double level = 0.95;     ///< of intervals, 0..1; a test is significant below 1 − level
  double power = 0.8;      ///< for which participants are planned, 0..1
  std::uint64_t seed = 1;  ///< of random splits, where there are too many to take all
  /// γ and λ of psychometric functions, 0..0.9 and 0..0.5; default: chance, or 0 of answers of kind
  /// Felt, and kLapse
  std::optional<double> guess = {}, lapse = {};
  bool fit_lapse = false;  ///< λ is fitted to each function's answers, from 0 to kMostLapse
};
inline constexpr double kLapse = 0.02;

/// How one method did in one scene, or in all.
struct MethodResult {
  std::string method;
  Proportion correct;                   ///< over all answers
  Interval interval;                    ///< Wilson's, as if answers were independent
  double p_chance = 1.0;                ///< of guessing, exact
  std::vector<double> of_participants;  ///< each one's share of right answers, in order of names
  std::optional<TestResult> dispersion;
  std::optional<Sensitivity> sensitivity;  ///< where questions are known and were of both kinds
};

/// A second method against the first in one scene, or in all.
struct Comparison {
  std::string first, second;
  TestResult pooled_z;    ///< over answers
  double fisher_p = 1.0;  ///< over answers, exact
  /// over participants; nothing with fewer than two with each method
  std::optional<Permutation> permutation;
  std::optional<TestResult> t;  ///< over participants: Welch's, or of pairs
  std::optional<double> d;      ///< effect size over participants
  std::optional<int> needed;    ///< participants that would show this effect, of a group or in all
};

/// All of one scene.
struct SceneResult {
  std::string scene;  ///< empty: all scenes
  std::vector<MethodResult> methods;
  std::vector<Comparison> comparisons;  ///< of every pair of methods
};

/// Trials of one method in one scene that have no answer.
struct MissingAnswers {
  std::string method, scene;
  int missing = 0, trials = 0;
  int participants = 0;  ///< who left some out
  /// share of right answers if the missing ones were all wrong, and if all were right
  Interval if_answered;
};

struct Analysis {
  AnalysisSettings settings;
  AnswerKind kind = AnswerKind::Right;  ///< of kind Felt, "correct" is for the level
  Groups groups = Groups::Between;
  std::vector<std::string> participants;
  std::vector<MissingAnswers> missing;      ///< of all methods and scenes, if any answer is missing
  std::vector<std::string> left_out;        ///< participants without any answer to some scene
  std::vector<SceneResult> scenes;          ///< all scenes together first
  std::vector<ThresholdResult> thresholds;  ///< where answers have levels
};

/// Methods and scenes stand in the order in which the answers have them first. Trials without an
/// answer are counted and left out; so is a participant who answered none of the trials of a method
/// in a scene. @throws InputError: no answer, some participants with one method and others with
/// several, a scene that a participant has no trials of, a level that some answers lack, guess or
/// lapse without levels, answers of several kinds. @throws std::invalid_argument: a setting out of
/// its bounds.
/// @pre answers are not of kind Adjusted.
Analysis analyse(std::span<const Answer> answers, const AnalysisSettings& settings = {});

/// Counts trials without an answer by method and scene; empty if there are no such trials.
std::vector<MissingAnswers> missing_answers(std::span<const Answer> answers);

/// Sentences about trials without an answer; empty if there are no such trials.
/// @param kind of the answers.
std::string in_words(std::span<const MissingAnswers> missing, AnswerKind kind);

/// A paragraph in plain words: what the data support, what they do not, and why.
std::string in_words(const Analysis& analysis);
/// "p = 0.012", or "p < 0.001".
std::string p_in_words(double p);

}  // namespace prostm
