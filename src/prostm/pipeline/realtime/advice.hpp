#pragma once
/// Advice for runs that do not hold their rates. Each option is chosen from its effect on the
/// rates and on the stimulus of the scene; all messages of a run take it from here.

#include <array>
#include <cstdint>
#include <string>

#include "prostm/pipeline/settings.hpp"

namespace prostm {

/// Time that each of the two threads computes, at the median or on the mean [s].
struct WorkTime {
  double step = 0.0;  ///< everything that the world's thread does for a step
  double plan = 0.0;  ///< everything that the planner's thread does for a plan
};

/// The thread that has too much to do.
enum class Busy : std::uint8_t { Step, Plan, Neither };
Busy busy(const WorkTime& work, const PipelineSettings& settings);

enum class AdviceKind : std::uint8_t {
  None,         ///< nothing to advise
  OneField,     ///< leave out the parts of the pressure, which are only recorded
  Grid,         ///< a coarser grid, which keeps the stimulus
  UnknownGrid,  ///< a coarser grid, whose effect on the stimulus is not known
  FastPreset,   ///< leaves the stimulus, which is made before plans, as it is
  FewerPaths,   ///< likewise
  NoOption      ///< none is fast enough and keeps the stimulus
};

struct Advice {
  AdviceKind kind = AdviceKind::None;
  int cells = 0;  ///< of Grid and UnknownGrid
  Busy cause = Busy::Neither;
  bool operator==(const Advice&) const = default;
};

/// Advice for a run whose rates are missed.
Advice advise(const WorkTime& work, const PipelineSettings& settings);

/// The advice in a sentence or two; empty for None.
std::string sentence(const Advice& advice, const PipelineSettings& settings);

/// Keeps to one option for each cause while the settings that it is chosen from stay, so that the
/// messages of a run never contradict each other, however its times vary.
class Adviser {
 public:
  const Advice& advise(const WorkTime& work, const PipelineSettings& settings);
  /// Whether the options given are for these settings.
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
  std::array<Advice, 2> given_;  // for work of a step, and for that of a plan
};

}  // namespace prostm
