#pragma once
/// Who took part in a study, from the participants' files.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "prostm/core/text/names.hpp"
#include "prostm/study/session/response_file.hpp"

namespace prostm {

enum class Attendance : std::uint8_t {
  UnderWay,  ///< answers are missing, and the session can go on
  Complete,  ///< all answers are there
  Left       ///< withdrew
};
template <>
inline constexpr std::array<std::string_view, 3> kNames<Attendance> = {"under way", "complete",
                                                                       "left"};

/// A participant, as their file tells of them.
struct RosterEntry {
  std::string file, participant;
  std::string replaces;     ///< the participant whose place they took; empty: nobody's
  int order = 0;            ///< number whose methods and orders they have: theirs, or that of
                            ///< the first who had the place
  std::size_t answers = 0;  ///< given
  std::size_t trials = 0;   ///< in all, or at most
  Attendance attendance = Attendance::UnderWay;
  bool rehearsal = false;
  ResponseLine protocol;
};

/// Reads a participant's file. @return nothing: the file does not begin as one.
/// @throws InputError: what responses_from_text() throws, a first line that is not whole.
std::optional<RosterEntry> roster_entry(std::string_view text, const std::string& file);

/// The files in a folder whose names end in .jsonl, in order. @throws InputError: no such folder.
std::vector<std::string> response_files_in(const std::string& folder);

/// Reads files; those of no participant are left out. @param faults gets the sentences of files
/// that cannot be read; null: they are thrown. @throws InputError.
std::vector<RosterEntry> read_roster(std::span<const std::string> files,
                                     std::vector<std::string>* faults = nullptr);

/// The entry of a participant, by study::spelling_key(); null without one.
const RosterEntry* find_participant(std::span<const RosterEntry> roster, std::string_view id);

/// The entry that took the place of this one; null if none did.
const RosterEntry* replacement_of(std::span<const RosterEntry> roster, const RosterEntry& entry);

}  // namespace prostm
