#pragma once
/// The conclusions that the answers of a study do and do not support.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "prostm/study/analysis/effects.hpp"
#include "prostm/study/analysis/scores.hpp"
#include "prostm/study/analysis/thresholds.hpp"
#include "prostm/study/task/statistics.hpp"

namespace prostm {

struct AnalysisSettings {
  double chance = 0.5;  ///< share of right answers when guessing, 0..1
  double level = 0.95;  ///< confidence level, 0..1; a test is significant if p < 1 − level
  /// Bound of the equivalence test: differences of shares within ± this are of no interest, 0..1
  std::optional<double> equivalence = {};
  std::uint64_t seed = 1;  ///< random seed, used if there are too many splits to count all
  /// γ and λ of psychometric functions, 0..0.9 and 0..0.5; default: γ = chance, or 0 for answers of
  /// kind Felt, and λ = kLapse
  std::optional<double> guess = {}, lapse = {};
  bool fit_lapse = false;  ///< fit λ to each function's answers, between 0 and kMostLapse
};
inline constexpr double kLapse = 0.02;

/// The result of one method in one scene, or in all.
struct MethodResult {
  std::string method;
  Proportion correct;                   ///< over all answers
  Interval interval;                    ///< Wilson's, assuming independent answers
  double p_chance = 1.0;                ///< against guessing, exact
  std::vector<double> of_participants;  ///< shares of right answers, sorted by name
  std::optional<TestResult> dispersion;
  std::optional<Sensitivity> sensitivity;  ///< if questions are known and both kinds occurred:
                                           ///< about the stimulus, and about another
};

/// Comparison of two methods in one scene, or in all.
struct Comparison {
  std::string first, second;
  TestResult pooled_z;    ///< over answers
  double fisher_p = 1.0;  ///< over answers, exact
  /// over participants; nothing with fewer than two with each method
  std::optional<Permutation> permutation;
  /// p of `permutation`, corrected by Holm's method for all comparisons of the analysis
  std::optional<double> holm_p;
  std::optional<TestResult> t;         ///< over participants: Welch's, or paired
  std::optional<Estimate> difference;  ///< of the means of participants' shares
  std::optional<Estimate> effect;      ///< Cohen's d, or d_z of pairs
  std::optional<double> bayes_factor;  ///< of a difference over none
  std::optional<Equivalence> equal;    ///< if settings have a bound
};

/// The results of one scene.
struct SceneResult {
  std::string scene;  ///< empty: all scenes
  std::vector<MethodResult> methods;
  std::vector<Comparison> comparisons;  ///< for every pair of methods
};

/// Trials without an answer of one method in one scene.
struct MissingAnswers {
  std::string method, scene;
  int missing = 0, trials = 0;
  int participants = 0;  ///< participants with missing answers
  /// shares of right answers if all missing ones were wrong, and if all were right
  Interval if_answered;
};

struct Analysis {
  AnalysisSettings settings;
  AnswerKind kind = AnswerKind::Right;  ///< for kind Felt, "correct" means for the level
  Groups groups = Groups::Between;
  std::vector<std::string> participants;
  std::vector<MissingAnswers> missing;  ///< for all methods and scenes, if any answer is missing
  std::vector<std::string> left_out;    ///< participants without any answer to some scene
  std::vector<SceneResult> scenes;      ///< first all scenes together, then each scene
  std::vector<ThresholdResult> thresholds;  ///< if answers have levels
};

/// Analyses answers. Methods and scenes are in order of first appearance. Trials without an answer
/// are counted and left out; so is a participant who answered none of the trials of a method in a
/// scene. @throws InputError: no answer, some participants with one method and others with several,
/// a participant without trials of some scene, some answers without a level, guess or lapse without
/// levels, answers of several kinds. @throws std::invalid_argument: a setting out of bounds.
/// @pre answers are not of kind Adjusted.
Analysis analyse(std::span<const Answer> answers, const AnalysisSettings& settings = {});

/// Counts trials without an answer by method and scene; empty if there are no such trials.
std::vector<MissingAnswers> missing_answers(std::span<const Answer> answers);

/// Sentences about trials without an answer; empty if there are no such trials.
/// @param kind the kind of the answers.
std::string in_words(std::span<const MissingAnswers> missing, AnswerKind kind);

/// Describes in plain words what the data support, what they do not, and why.
std::string in_words(const Analysis& analysis);
/// A Bayes factor with three digits: "1.13", or "2.4e+05".
std::string factor_in_words(double factor);
/// "p = 0.012", or "p < 0.001".
std::string p_in_words(double p);

}  // namespace prostm
