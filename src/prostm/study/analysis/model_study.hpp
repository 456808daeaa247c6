#pragma once
/// Studies with model participants instead of people: answers, shares of right ones and how likely
/// they make the scores of a real study.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "prostm/core/random.hpp"
#include "prostm/study/analysis/observer.hpp"
#include "prostm/study/analysis/scores.hpp"
#include "prostm/study/task/statistics.hpp"

namespace prostm {

/// The scenes of the paper's study.
inline constexpr std::array kStudyScenes = {"one-plume", "four-plumes"};

/// A participant whose answers are chances.
struct ModelParticipant {
  double d_prime = 0.0;
  /// Chance of a right answer in each trial that may be drawn, for each of kStudyScenes.
  std::array<std::vector<double>, 2> right;

  double mean_right(std::size_t scene) const;  ///< over the trials
};

/// Percepts of one participant in each of kStudyScenes, moment by moment.
using FeltScenes = std::array<std::vector<Percept>, 2>;
/// Moments that an observer feels in a trial.
inline constexpr std::size_t kTrialMoments = 3;
/// Lets an observer learn the means of every second moment as templates, and answer in trials: each
/// run of kTrialMoments of the other moments, whose mean it feels. Training and trials take turns,
/// so that nothing that drifts is felt in one of them alone.
/// @throws std::invalid_argument: fewer than 2 kTrialMoments moments; as TemplateObserver does.
ModelParticipant observe(const FeltScenes& felt, const ObserverNoise& noise, double lapse);

struct StudyShape {
  int participants = 8;  ///< with each method
  int trials = 16;       ///< of each, half of them in each scene
};
/// @throws std::invalid_argument: participants not in 2 to 1000, trials not in 2 to 1000 or odd.
void validate(const StudyShape& shape);

/// Simulates one study: participants are drawn from `pool` with replacement, trials from those of a
/// participant, scenes and questions are balanced and come in random order. Participants are named
/// "model-METHOD-1" and so on. @pre the shape is valid, nobody in the pool is without trials.
std::vector<Answer> simulate_study(std::span<const ModelParticipant> pool, const StudyShape& shape,
                                   const std::string& method, Random& random);

/// Share of right answers: of the pool, and where it lies in 95 % of simulated studies.
struct SimulatedShare {
  double mean = 0.0;
  Interval interval;
};
/// The shares in each of kStudyScenes, then in both. @pre as simulate_study(), studies > 0.
std::array<SimulatedShare, 3> simulate_shares(std::span<const ModelParticipant> pool,
                                              const StudyShape& shape, int studies,
                                              std::uint64_t seed);

/// Logarithm of the chance that participants drawn from the pool have just these scores: for each
/// real participant the pool's mean of the product of both scenes' binomial chances, (Y5).
/// @pre every trial's chance in the pool is above 0 and below 1, so that no score is impossible.
double log_likelihood(std::span<const ModelParticipant> pool, std::span<const Answer> answers);

}  // namespace prostm
