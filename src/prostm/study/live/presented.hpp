#pragma once
/// The settings that present the stimulus a session wants, and the emission of a plan.

#include <optional>

#include "prostm/pipeline/settings.hpp"
#include "prostm/pipeline/snapshot.hpp"
#include "prostm/study/session/session.hpp"
#include "prostm/study/session/study_sight.hpp"

namespace prostm {

/// The settings of the run that present a stimulus: those of its method, with its level and scene.
PipelineSettings settings_for(const Protocol& protocol, const StudyWanted& wanted);

/// How a plan is played; nothing without a plan.
std::optional<StudyPlayed> played_of(const PlanSnapshot& plan);

}  // namespace prostm
