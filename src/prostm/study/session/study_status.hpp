#pragma once
/// The number of participants in each group of a study.

#include <span>
#include <string>
#include <vector>

#include "prostm/study/session/roster.hpp"

namespace prostm {

/// The participants who get the same methods in the same order.
struct GroupStatus {
  std::vector<std::string> methods;  ///< in order of presentation
  int planned = 0;                   ///< planned participants, numbered up to `study.participants`
  int complete = 0, under_way = 0, left = 0;  ///< participants, without those who were replaced
  std::vector<int> open;                      ///< planned numbers that nobody has taken
};

struct StudyStatus {
  std::string title;
  int planned = 0;                        ///< planned participants
  std::vector<GroupStatus> groups;        ///< in order of their first number
  std::vector<RosterEntry> participants;  ///< sorted by file name
};

/// Groups participants by protocol, and counts them. @throws InputError: a participant with two
/// files, an incomplete protocol.
std::vector<StudyStatus> study_status(std::span<const RosterEntry> roster);

/// The methods of a participant, in order.
std::vector<std::string> methods_of(const RosterEntry& entry);

}  // namespace prostm
