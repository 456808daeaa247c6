#pragma once
/// The participant of a session: their number, file, place in the order, and simulated answers.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "options.hpp"
#include "prostm/pipeline/settings.hpp"
#include "prostm/study/protocol/protocol.hpp"
#include "prostm/study/session/rehearsal.hpp"
#include "prostm/study/session/session.hpp"

namespace prostm::app {

struct SessionPlace {
  int participant = 0;
  std::string path;                     ///< the participant's file
  std::optional<Replacement> replaces;  ///< the participant whom this one replaces, if any
};
/// Finds the participant's place, and creates the folder of the file. @throws InputError: the
/// number is out of range, the participant has begun but --resume is not given, or the other way
/// round; the one to replace is missing, was replaced before, or had another protocol.
SessionPlace session_place(const StudyRunOptionsGiven& given, const Protocol& protocol);

/// The simulated answers of --rehearse; nothing if people answer.
std::optional<Rehearsal> rehearsal_of(const StudyRunOptionsGiven& given, int participant);

/// Facts about the run, for the first line of the file. @param settings of the run.
nlohmann::ordered_json run_facts(const StudyRunOptionsGiven& given,
                                 const PipelineSettings& settings);

}  // namespace prostm::app
