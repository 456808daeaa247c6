#include "study/session/session_place.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "prostm/commit.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/study/session/roster.hpp"
#include "prostm/study/session/spelling.hpp"
#include "prostm/study/task/protocol_file.hpp"

namespace prostm::app {
namespace {

constexpr int kMostParticipants = 9999;

/// The number that --participant gives; 01 is 1. @throws InputError: it is not a number, or out of
/// range.
int participant_of(const StudyRunOptionsGiven& given) {
  const std::string id = study::trimmed(given.participant);
  int number = 0;
  const auto [end, wrong] = std::from_chars(id.data(), id.data() + id.size(), number);
  if (wrong != std::errc() || end != id.data() + id.size() || number < 1 ||
      number > kMostParticipants) {
    throw InputError(fmt::format("--participant {} must be a number between 1 and {}",
                                 given.participant, kMostParticipants));
  }
  return number;
}

/// Returns the participant's file. @throws InputError: the participant has begun but --resume is
/// not given, or the other way round; the folder cannot be made.
std::string file_of(const StudyRunOptionsGiven& given, int participant) {
  if (given.rehearse && *given.rehearse < 0)
    throw InputError(fmt::format("--rehearse {} must be 0 or more trials", *given.rehearse));
  std::error_code wrong;
  std::filesystem::create_directories(given.folder, wrong);
  if (wrong) {
    throw InputError(
        fmt::format("--answers {} cannot be a folder: {}", given.folder, wrong.message()));
  }
  const char* kind = given.rehearse ? "rehearsal" : "participant";
  const std::string path =
      (std::filesystem::path(given.folder) / fmt::format("{}-{}.jsonl", kind, participant))
          .string();
  const bool begun = std::filesystem::exists(path) && !std::filesystem::is_empty(path);
  if (begun && !given.resume) {
    throw InputError(
        fmt::format("participant {} has begun ({}); use another number for a new one, or --resume "
                    "to continue with this one",
                    participant, path));
  }
  if (!begun && given.resume) {
    throw InputError(fmt::format("participant {} has not begun: there is no {}; leave --resume out",
                                 participant, path));
  }
  return path;
}

/// Returns all who have a file in the folder, or have rehearsed. Files that cannot be read are
/// ignored: they must not stop another participant.
std::vector<RosterEntry> roster_of(const StudyRunOptionsGiven& given) {
  std::vector<std::string> faults;
  auto roster = read_roster(response_files_in(given.folder), &faults);
  std::erase_if(roster,
                [&](const RosterEntry& e) { return e.rehearsal != given.rehearse.has_value(); });
  return roster;
}

/// Returns the participant whom this one replaces, if any.
/// @throws InputError: the participant has another file; the one to replace does not exist, was
/// replaced before, or belongs to another protocol.
std::optional<Replacement> replacement_for(const StudyRunOptionsGiven& given, int participant,
                                           const std::string& path, const Protocol& protocol) {
  const std::vector<RosterEntry> roster = roster_of(given);
  const RosterEntry* self = find_participant(roster, std::to_string(participant));
  if (self != nullptr && self->file != path) {
    throw InputError(
        fmt::format("participant {} has begun in {}; use another number for the new one, or rename "
                    "that file to "
                    "{} to continue with it",
                    participant, self->file, path));
  }
  if (self != nullptr && (given.replaces.empty() || study::spelling_key(given.replaces) ==
                                                        study::spelling_key(self->replaces))) {
    if (self->replaces.empty()) return {};
    return Replacement{self->replaces, self->order};
  }
  if (self != nullptr) {
    throw InputError(fmt::format(
        "participant {} began {}; leave --replaces out", participant,
        self->replaces.empty() ? "without --replaces" : "with --replaces " + self->replaces));
  }
  if (given.replaces.empty()) return {};
  const RosterEntry* replaced = find_participant(roster, given.replaces);
  if (replaced == nullptr) {
    throw InputError(fmt::format(
        "--replaces {}: no participant of this number has a file in {}; prostm study status lists "
        "them",
        given.replaces, given.folder));
  }
  if (const RosterEntry* by = replacement_of(roster, *replaced)) {
    throw InputError(fmt::format("participant {0} was replaced by {1} before; give --replaces {1}",
                                 replaced->participant, by->participant));
  }
  if (replaced->protocol != protocol_json(protocol)) {
    throw InputError(
        fmt::format("participant {} had another protocol than {}, so their place does "
                    "not belong to this study",
                    replaced->participant, given.protocol));
  }
  return Replacement{replaced->participant, replaced->order};
}

}  // namespace

SessionPlace session_place(const StudyRunOptionsGiven& given, const Protocol& protocol) {
  SessionPlace place;
  place.participant = participant_of(given);
  place.path = file_of(given, place.participant);
  place.replaces = replacement_for(given, place.participant, place.path, protocol);
  return place;
}

std::optional<Rehearsal> rehearsal_of(const StudyRunOptionsGiven& given, int participant) {
  if (!given.rehearse) return {};
  return Rehearsal(static_cast<std::size_t>(*given.rehearse),
                   static_cast<std::uint64_t>(participant));
}

nlohmann::ordered_json run_facts(const StudyRunOptionsGiven& given,
                                 const PipelineSettings& settings) {
  nlohmann::ordered_json facts = {{"prostm", version_text()},
                                  {"device", settings.device},
                                  {"array", settings.array},
                                  {"hand", given.run.hand},
                                  {"rehearsal", given.rehearse.has_value()}};
  if (given.as_fast_as_possible) facts["clock"] = "simulated";
  return facts;
}

}  // namespace prostm::app
