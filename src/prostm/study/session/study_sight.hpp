#pragma once
/// The state of the run, as input to a session.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "prostm/core/geometry.hpp"
#include "prostm/stimulus/stimulus_gate.hpp"
#include "prostm/study/session/participant_page.hpp"

namespace prostm {

/// Emission of a plan.
struct StudyPlayed {
  double speed = 0.0;   ///< mean speed of its focal points [m/s]; 0 if they stand still
  double period = 0.0;  ///< of its longest loop, or of the modulation [s]
  int changed = 0;      ///< number of paths played at another period than planned
};
/// Emission in the units of participants' files.
nlohmann::ordered_json played_json(const StudyPlayed& played);

/// Current state of the run.
struct StudySight {
  double time = 0.0;                       ///< by a steady clock [s]
  double utc = 0.0;                        ///< since 1970 [s]
  bool in_force = false;                   ///< whether the run plays the wanted stimulus
  std::optional<Pose> palm;                ///< in D; none without a hand
  std::optional<GateResult> gate;          ///< of the newest target
  double target_force = 0.0;               ///< of the newest target [N]
  double rendered_force = 0.0;             ///< rendered for that target [N]
  std::optional<StudyPlayed> played = {};  ///< of the newest plan; none without one
  ParticipantPage page;
};

/// UTC time as ISO 8601 text with milliseconds.
std::string utc_text(double seconds_since_1970);

}  // namespace prostm
