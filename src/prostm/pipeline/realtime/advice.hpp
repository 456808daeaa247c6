#pragma once
/// Advice for runs that do not keep up. Options are chosen by their effect on the rates and on the
/// stimulus of the scene; all messages of a run use this advice.

#include <array>
#include <cstdint>
#include <string>

#include "prostm/pipeline/settings.hpp"

namespace prostm {

/// Computing time of each of the two threads, median or mean [s].
struct WorkTime {
  double step = 0.0;  ///< world's thread, per step
  double plan = 0.0;  ///< planner's thread, per plan
};

/// The thread that is overloaded.
enum class Busy : std::uint8_t { Step, Plan, Neither };
Busy busy(const WorkTime& work, const PipelineSettings& settings);

enum class AdviceKind : std::uint8_t {
  None,         ///< nothing to advise
  OneField,     ///< do not compute the parts of the pressure, which are only recorded
  Grid,         ///< a coarser grid that keeps the stimulus
  UnknownGrid,  ///< a coarser grid with unknown effect on the stimulus
  FastPreset,   ///< does not affect the stimulus, which is made before plans
  FewerPaths,   ///< likewise
  NoOption      ///< no option is fast enough and keeps the stimulus
};

struct Advice {
  AdviceKind kind = AdviceKind::None;
  int cells = 0;  ///< for Grid and UnknownGrid
  Busy cause = Busy::Neither;
  bool operator==(const Advice&) const = default;
};

/// Advice for a run whose rates are missed.
Advice advise(const WorkTime& work, const PipelineSettings& settings);

/// The advice in a sentence or two; empty for None.
std::string sentence(const Advice& advice, const PipelineSettings& settings);

/// Keeps the first option for each cause until the relevant settings change, so that the messages
/// of a run never contradict each other, however its times vary.
class Adviser {
 public:
  const Advice& advise(const WorkTime& work, const PipelineSettings& settings);
  /// Whether the options given so far are for these settings.
  bool is_for(const PipelineSettings& settings) const { return key_of(settings) == key_; }

 private:
  struct Key {
    std::string scene;
    FluidSettings fluid;
    bool parts = false;
    Method method = Method::ProStm;
    Preset preset = kDefaultPreset;
    int paths = 0;
    double world_rate = 0.0;
    bool operator==(const Key&) const = default;
  };
  static Key key_of(const PipelineSettings& settings);

  Key key_;
  std::array<Advice, 2> given_;  // for an overloaded step, and for an overloaded plan
};

}  // namespace prostm
