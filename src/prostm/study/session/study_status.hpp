#pragma once
/// How full the groups of a study are.

#include <span>
#include <string>
#include <vector>

#include "prostm/study/session/roster.hpp"

namespace prostm {

/// The participants who get the same methods in the same order.
struct GroupStatus {
  std::vector<std::string> methods;           ///< in the order in which they come
  int planned = 0;                            ///< numbers up to the protocol's `study.participants`
  int complete = 0, under_way = 0, left = 0;  ///< who hold a place: those replaced hold none
  std::vector<int> open;                      ///< planned numbers whose place nobody holds
};

struct StudyStatus {
  std::string title;
  int planned = 0;                        ///< participants
  std::vector<GroupStatus> groups;        ///< as they come first among the numbers
  std::vector<RosterEntry> participants;  ///< by their file's name
};

/// Sorts participants by the protocol that they had, and counts. @throws InputError: a participant
/// has two files, a protocol that is not whole.
std::vector<StudyStatus> study_status(std::span<const RosterEntry> roster);

/// The methods of a participant, in order.
std::vector<std::string> methods_of(const RosterEntry& entry);

}  // namespace prostm
