#pragma once
/// The run as a session sees it.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "prostm/core/geometry.hpp"
#include "prostm/stimulus/stimulus_gate.hpp"
#include "prostm/study/session/participant_page.hpp"

namespace prostm {

/// Emission of a plan.
struct StudyPlayed {
  double speed = 0.0;   ///< mean of its focal points [m/s]; 0 where they stand still
  double period = 0.0;  ///< of its longest lap, or of the modulation [s]
  int changed = 0;      ///< paths that are played at another period than planned
};
/// In the units of participants' files.
nlohmann::ordered_json played_json(const StudyPlayed& played);

/// The run as it is now.
struct StudySight {
  double time = 0.0;                       ///< of a clock that never jumps [s]
  double utc = 0.0;                        ///< since 1970 [s]
  bool in_force = false;                   ///< whether the run plays what is wanted
  std::optional<Pose> palm;                ///< in D; none without a hand
  std::optional<GateResult> gate;          ///< of the newest target
  double target_force = 0.0;               ///< of it [N]
  double rendered_force = 0.0;             ///< of what is rendered for it [N]
  std::optional<StudyPlayed> played = {};  ///< of the newest plan; none without one
  ParticipantPage page;
};

/// UTC as ISO 8601 with milliseconds.
std::string utc_text(double seconds_since_1970);

}  // namespace prostm
