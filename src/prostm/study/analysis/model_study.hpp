#pragma once
/// Simulated studies with model participants: answers, shares of right answers, and the likelihood
/// of a real study's scores.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "prostm/core/random.hpp"
#include "prostm/psychophysics/observer.hpp"
#include "prostm/psychophysics/template_observer.hpp"
#include "prostm/study/analysis/percepts.hpp"
#include "prostm/study/analysis/scores.hpp"
#include "prostm/study/task/statistics.hpp"

namespace prostm {

/// The scenes of the paper's study.
inline constexpr std::array kStudyScenes = {"one-plume", "four-plumes"};

/// A model participant, described by the probability of a right answer in each trial.
struct ModelParticipant {
  double d_prime = 0.0;
  /// Probability of a right answer in each available trial, for each of kStudyScenes.
  std::array<std::vector<double>, 2> right;

  double mean_right(std::size_t scene) const;  ///< mean over the trials
};

/// Percepts of one participant in each of kStudyScenes, moment by moment.
using FeltScenes = std::array<std::vector<Percept>, 2>;
/// Number of moments that an observer feels in a trial.
inline constexpr std::size_t kTrialMoments = 3;
/// Simulates an observer. Its templates are the means of every second moment. Each run of
/// `in_trial` of the other moments is a trial, in which it feels their mean. Training and trial
/// moments alternate, so that slow drifts affect both equally.
/// @throws std::invalid_argument: fewer than 2 in_trial moments; or as TemplateObserver.
ModelParticipant observe(const FeltScenes& felt, const ObserverNoise& noise, double lapse,
                         std::size_t in_trial = kTrialMoments);

/// The same for percepts of any model: for each hand, participants of several thresholds, which
/// spread by kThresholdSpread about the observer's. A template observer has its places as above; a
/// category observer the deepest dip, and its training's middle as the criterion.
/// Without a threshold, 0, all of a hand are alike. @param felt moments of both scenes.
std::vector<ModelParticipant> observe_as(const Observer& observer,
                                         const std::array<std::vector<ModelPercept>, 2>& felt,
                                         double lapse, std::size_t in_trial = kTrialMoments);

struct StudyShape {
  int participants = 8;  ///< participants with each method
  int trials = 16;       ///< trials of each participant, half of them in each scene
};
/// @throws std::invalid_argument: participants not in 2 to 1000, trials not in 2 to 1000 or odd.
void validate(const StudyShape& shape);

/// Simulates one study: participants are drawn from `pool` with replacement, trials from those of a
/// participant, scenes and questions are balanced and in random order. Participants are named
/// "model-METHOD-1" and so on. @pre the shape is valid, everybody in the pool has trials.
std::vector<Answer> simulate_study(std::span<const ModelParticipant> pool, const StudyShape& shape,
                                   const std::string& method, Random& random);

/// Share of right answers: mean of the pool, and the range that holds 95 % of simulated studies.
struct SimulatedShare {
  double mean = 0.0;
  Interval interval;
};
/// The shares in each of kStudyScenes, then in both together. @pre as simulate_study(), studies >
/// 0.
std::array<SimulatedShare, 3> simulate_shares(std::span<const ModelParticipant> pool,
                                              const StudyShape& shape, int studies,
                                              std::uint64_t seed);

/// Log-likelihood of these scores for participants drawn from the pool: for each real participant,
/// the pool's mean of the product of both scenes' binomial probabilities, (Y5). @pre every trial's
/// probability in the pool is above 0 and below 1, so that no score is impossible.
double log_likelihood(std::span<const ModelParticipant> pool, std::span<const Answer> answers);

}  // namespace prostm
