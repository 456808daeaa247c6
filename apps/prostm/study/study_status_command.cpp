#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "common.hpp"
#include "options.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/study/session/study_status.hpp"

namespace prostm::app {
namespace {

std::vector<RosterEntry> roster_of(const std::vector<std::string>& paths) {
  std::vector<std::string> files;
  for (const std::string& path : paths) {
    if (!std::filesystem::is_directory(path)) {
      files.push_back(path);
      continue;
    }
    const auto found = response_files_in(path);
    files.insert(files.end(), found.begin(), found.end());
  }
  return read_roster(files);
}

std::string title_of(const StudyStatus& study) {
  return study.title.empty() ? "A study" : study.title;
}

std::string state_of(const StudyStatus& study, const RosterEntry& entry) {
  std::string state(name_of(entry.attendance));
  if (!entry.replaces.empty()) state += ", replaces " + entry.replaces;
  const RosterEntry* by = replacement_of(study.participants, entry);
  if (by != nullptr) state += ", replaced by " + by->participant;
  return state;
}

void print_groups(std::FILE* out, const StudyStatus& study) {
  std::size_t width = 7;
  for (const GroupStatus& g : study.groups)
    width = std::max(width, fmt::format("{}", fmt::join(g.methods, ", ")).size());
  fmt::print(out, "  {:<{}}  planned  complete  under way  left  open\n", "methods", width);
  for (const GroupStatus& g : study.groups) {
    fmt::print(out, "  {:<{}}  {:>7}  {:>8}  {:>9}  {:>4}  {:>4}\n",
               fmt::format("{}", fmt::join(g.methods, ", ")), width, g.planned, g.complete,
               g.under_way, g.left, g.open.size());
  }
}

void print_participants(std::FILE* out, const StudyStatus& study) {
  fmt::print(out, "\n  participant  answers    state\n");
  for (const RosterEntry& e : study.participants) {
    fmt::print(out, "  {:>11}  {:<9}  {}\n", e.participant,
               fmt::format("{}/{}", e.answers, e.trials), state_of(study, e));
  }
}

/// Prints which numbers come next, and which participants can be replaced.
void print_next(std::FILE* out, const StudyStatus& study) {
  std::vector<int> open;
  for (const GroupStatus& g : study.groups) open.insert(open.end(), g.open.begin(), g.open.end());
  std::sort(open.begin(), open.end());
  if (!open.empty()) fmt::print(out, "Not begun: {}\n", fmt::join(open, ", "));
  for (const RosterEntry& e : study.participants) {
    if (e.attendance != Attendance::Left || replacement_of(study.participants, e) != nullptr)
      continue;
    fmt::print(out, "Participant {0} left; a new one takes this place with --replaces {0}\n",
               e.participant);
  }
}

nlohmann::ordered_json status_json(const StudyStatus& study) {
  nlohmann::ordered_json groups = nlohmann::ordered_json::array(),
                         participants = nlohmann::ordered_json::array();
  for (const GroupStatus& g : study.groups) {
    groups.push_back({{"methods", g.methods},
                      {"planned", g.planned},
                      {"complete", g.complete},
                      {"under_way", g.under_way},
                      {"left", g.left},
                      {"open", g.open}});
  }
  for (const RosterEntry& e : study.participants) {
    const RosterEntry* by = replacement_of(study.participants, e);
    nlohmann::ordered_json& json =
        participants.emplace_back(nlohmann::ordered_json{{"participant", e.participant},
                                                         {"file", e.file},
                                                         {"methods", methods_of(e)},
                                                         {"answers", e.answers},
                                                         {"trials", e.trials},
                                                         {"state", name_of(e.attendance)}});
    json["replaces"] = e.replaces.empty() ? nullptr : nlohmann::ordered_json(e.replaces);
    json["replaced_by"] = by == nullptr ? nullptr : nlohmann::ordered_json(by->participant);
  }
  return {{"title", study.title},
          {"planned", study.planned},
          {"groups", groups},
          {"participants", participants}};
}

}  // namespace

int study_status_command(const StudyStatusOptionsGiven& given) {
  std::vector<RosterEntry> roster = roster_of(given.answers);
  const auto rehearsals =
      std::erase_if(roster, [](const RosterEntry& entry) { return entry.rehearsal; });
  if (roster.empty()) {
    throw InputError(fmt::format("{}: no participant's file of prostm study run",
                                 fmt::join(given.answers, ", ")));
  }
  const std::vector<StudyStatus> studies = study_status(roster);
  std::FILE* out = prose(given.json);
  nlohmann::ordered_json json = {{"format", "prostm-study-status/1"},
                                 {"studies", nlohmann::ordered_json::array()}};
  for (const StudyStatus& study : studies) {
    fmt::print(out, "{}: {} participants planned\n\n", title_of(study), study.planned);
    print_groups(out, study);
    print_participants(out, study);
    print_next(out, study);
    fmt::print(out, "\n");
    json["studies"].push_back(status_json(study));
  }
  if (studies.size() > 1) {
    fmt::print(out, "These are files of {} protocols: do not analyse them together.\n",
               studies.size());
  }
  if (rehearsals > 0) fmt::print(out, "Rehearsals left out: {}\n", rehearsals);
  write_json(given.json, json);
  say_written(out, given.json);
  return 0;
}

}  // namespace prostm::app
