#include "prostm/study/session/study_status.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "prostm/core/input_error.hpp"
#include "prostm/study/protocol/order.hpp"

namespace prostm {
namespace {

/// The part of a protocol that determines the order of methods. @throws InputError.
Protocol order_part(const RosterEntry& entry) {
  Protocol protocol;
  try {
    const ResponseLine& study = entry.protocol.at("study");
    protocol.study.title = study.at("title");
    protocol.study.participants = study.at("participants");
    protocol.study.seed = study.at("seed");
    protocol.study.methods =
        from_name<MethodsOf>(study.at("methods").get<std::string>(), "methods");
    const auto level = entry.protocol.value("level", ResponseLine::object());
    const std::string standard = level.value("against", "");
    for (const auto& [name, settings] : entry.protocol.at("method").items())
      if (name != standard) protocol.methods.push_back({name, {}});
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}, line 1: protocol: {}", entry.file, error.what()));
  }
  if (protocol.methods.empty() || entry.order < 1)
    throw InputError(entry.file + ", line 1: no method, or a participant that is not a number");
  return protocol;
}

std::vector<std::string> methods_of(const Protocol& protocol, int order) {
  std::vector<std::string> names;
  for (const int method : method_order(protocol, order))
    names.push_back(protocol.methods[static_cast<std::size_t>(method)].name);
  return names;
}

GroupStatus& group_with(std::vector<GroupStatus>& groups, std::vector<std::string> methods) {
  const auto found = std::find_if(groups.begin(), groups.end(),
                                  [&](const GroupStatus& g) { return g.methods == methods; });
  if (found != groups.end()) return *found;
  groups.emplace_back().methods = std::move(methods);
  return groups.back();
}

void count(StudyStatus& status) {
  const Protocol protocol = order_part(status.participants.front());
  status.title = protocol.study.title;
  status.planned = protocol.study.participants;
  std::vector<bool> held(static_cast<std::size_t>(status.planned));
  for (int number = 1; number <= status.planned; ++number)
    ++group_with(status.groups, methods_of(protocol, number)).planned;
  for (const RosterEntry& entry : status.participants) {
    if (replacement_of(status.participants, entry) != nullptr) continue;
    GroupStatus& group = group_with(status.groups, methods_of(protocol, entry.order));
    const Attendance at = entry.attendance;
    ++(at == Attendance::Complete ? group.complete
       : at == Attendance::Left   ? group.left
                                  : group.under_way);
    if (entry.order <= status.planned) held[static_cast<std::size_t>(entry.order) - 1] = true;
  }
  for (int number = 1; number <= status.planned; ++number)
    if (!held[static_cast<std::size_t>(number) - 1])
      group_with(status.groups, methods_of(protocol, number)).open.push_back(number);
}

}  // namespace

std::vector<std::string> methods_of(const RosterEntry& entry) {
  return methods_of(order_part(entry), entry.order);
}

std::vector<StudyStatus> study_status(std::span<const RosterEntry> roster) {
  std::vector<StudyStatus> studies;
  for (const RosterEntry& entry : roster) {
    auto study = std::find_if(studies.begin(), studies.end(), [&](const StudyStatus& s) {
      return s.participants.front().protocol == entry.protocol;
    });
    if (study == studies.end()) study = studies.emplace(studies.end());
    const RosterEntry* other = find_participant(study->participants, entry.participant);
    if (other != nullptr) {
      throw InputError(fmt::format("participant {} is in {} and in {}; leave one of them out",
                                   entry.participant, other->file, entry.file));
    }
    study->participants.push_back(entry);
  }
  for (StudyStatus& study : studies) count(study);
  return studies;
}

}  // namespace prostm
