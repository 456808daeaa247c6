#pragma once
/// The paper's study with the observers of the psychophysics.

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "prostm/psychophysics/observer.hpp"
#include "study/simulated_study.hpp"

namespace prostm::app {

/// Ends a simulation that was asked to stop.
struct StudyStopped {};

/// Quantities of the paper's study by name, as in kStudyQuantities.
using StudyQuantities = std::map<std::string, double>;

/// A variation of the simulated study, to test an explanation of the paper's result.
struct StudyVariation {
  const char* name = "as usual";
  const char* change = "nothing";  ///< in words
  void (*apply)(PipelineSettings& settings) = nullptr;
  SceneVariation scene = {};
  std::size_t in_trial = kTrialMoments;  ///< moments of a trial
};

/// Simulates the paper's study: its scenes with both methods on simulated hands, with the
/// calibrated array at full drive.
class StudyPredictions {
 public:
  /// @param hands number of simulated hands. @param go_on called repeatedly; returns false to stop.
  StudyPredictions(int hands, std::function<bool()> go_on, const StudyVariation& variation = {});

  /// Returns all quantities for an observer. The first call computes the percepts, which takes a
  /// minute.
  /// @param adaptation rise of the threshold by AM's steady vibration [dB].
  const StudyQuantities& of(const Observer& observer, double adaptation = 0.0);
  /// Mean strength with each method in each scene, (X7), over all hands [m, or Pa].
  std::array<std::array<double, 2>, 2> strengths(PerceptModel model);

 private:
  std::vector<ModelParticipant> pool(const Observer& observer, std::size_t method,
                                     double adaptation);
  void feel();

  SimulateOptionsGiven given_;
  std::function<bool()> go_on_;
  StudyVariation variation_;
  std::vector<HandPercepts> hands_;
  std::map<std::string, StudyQuantities> known_;
};

}  // namespace prostm::app
