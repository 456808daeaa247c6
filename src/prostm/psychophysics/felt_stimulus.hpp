#pragma once
/// Stimuli as the percept models feel them, (X6) to (X9) of docs/design/psychophysics.md.

#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "prostm/psychophysics/percept_model.hpp"
#include "prostm/psychophysics/presenter.hpp"

namespace prostm {

/// Time over which a percept is summed [s], (X9).
inline constexpr double kPerceptTime = 0.25;

/// A place that is felt for a time.
struct FeltPlace {
  double duration = 0.0;      ///< [s]
  Vec2 place = Vec2::Zero();  ///< centroid of the energy [m]
};

/// One stimulus as one model feels it.
struct FeltStimulus {
  SkinPatch patch{48, 48, 2e-3};
  std::vector<double> map;  ///< mean strength over time, blurred by kTouchResolution, rows·cols
  double strength = 0.0;    ///< largest over time, (X9)
  std::vector<FeltPlace> course;  ///< moment by moment
  double delay = 0.0;  ///< of a sweep: arrival at its last place after that at its first [s]; 0 for
                       ///< the models without time, and for other stimuli

  /// Returns the map at places, spaced by kTouchResolution.
  std::vector<double> places(const Vec2& shift = Vec2::Zero()) const;
};

/// A stimulus as each model of PerceptModel feels it.
using FeltByModel = std::array<FeltStimulus, kPerceptModels>;

/// Feels stimuli with all models, and keeps what was felt by name.
class Feeler {
 public:
  /// @param step called repeatedly; an exception that it throws ends the computation.
  Feeler(const SkinSettings& skin, const TransducerArray& array, std::function<void()> step);

  /// @param key the same for equal stimuli at equal heights, and for no others.
  const FeltByModel& feel(const std::string& key, const PresentedStimulus& stimulus, double height);

 private:
  Presenter presenter_;
  std::function<void()> step_;
  std::map<std::string, FeltByModel> felt_;
};

}  // namespace prostm
