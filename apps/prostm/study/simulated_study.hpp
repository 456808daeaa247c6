#pragma once
/// Model observers in the paper's study, from scenes on hands to shares of right answers. These are
/// models, not people.

#include <array>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "options.hpp"
#include "prostm/pipeline/settings.hpp"
#include "prostm/study/analysis/percepts.hpp"

namespace prostm::app {

/// One method, with its name in answers.
struct StudyMethod {
  const char* name;
  std::vector<StimulusPercept> ScenePercepts::*percepts;
  double of_people;  ///< share of right answers of people in the paper
};
inline constexpr std::array kStudyMethods = {StudyMethod{"am", &ScenePercepts::am, 0.61},
                                             StudyMethod{"pro-stm", &ScenePercepts::pro_stm, 0.76}};

using HandPercepts = std::array<ScenePercepts, 2>;  ///< of each of kStudyScenes

/// Renders both scenes on all hands and computes their percepts. @param go_on gets the numbers of
/// moments done and in total, on either of two threads; returning false stops. @return fewer hands
/// if stopped.
std::vector<HandPercepts> feel_hands(const SimulateOptionsGiven& given,
                                     const PipelineSettings& settings,
                                     const std::function<bool(int done, int all)>& go_on,
                                     const SceneVariation& variation = {});

/// One observer with one method.
struct ObserverRow {
  std::string observer, method;
  std::array<SimulatedShare, 3> share;  ///< of each of kStudyScenes, and of both
  double d_prime = 0.0;
  std::optional<double> log_likelihood;
  std::vector<ModelParticipant> pool;
};
/// All observers with both methods. @param people the paper's scores, or none.
std::vector<ObserverRow> observer_rows(const std::vector<HandPercepts>& hands,
                                       const SimulateOptionsGiven& given,
                                       const std::vector<Answer>& people);

/// The scores of people as shares, with Wilson's intervals.
std::array<SimulatedShare, 3> shares_of(const std::vector<Answer>& answers);
std::vector<Answer> answers_with(const std::vector<Answer>& answers, const std::string& method);
/// Returns a sentence on how well strength alone distinguishes the scenes.
std::string about_strength(const std::vector<ObserverRow>& rows,
                           const std::vector<HandPercepts>& hands);

/// Returns a sentence on the sensation levels of the scenes. @param sound acoustic pressure of a
/// focal point at intensity 1 [Pa, rms].
std::string about_sensation(const std::vector<HandPercepts>& hands, double sound);

nlohmann::ordered_json rows_json(const std::vector<ObserverRow>& rows);
/// Returns the paper's shares, and those of its participants if their scores are given.
nlohmann::ordered_json people_json(const std::vector<Answer>& people);

}  // namespace prostm::app
