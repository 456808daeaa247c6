#pragma once
/// The participants of a study, read from their files.

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
  UnderWay,  ///< answers are missing, and the session can be resumed
  Complete,  ///< all answers were given
  Left       ///< withdrew
};
template <>
inline constexpr std::array<std::string_view, 3> kNames<Attendance> = {"under way", "complete",
                                                                       "left"};

/// A participant, as described by their file.
struct RosterEntry {
  std::string file, participant;
  std::string replaces;  ///< the participant they replace; empty: nobody
  int order = 0;  ///< number that sets their methods and orders: their own, or that of the first
                  ///< participant they replace, directly or through others
  std::size_t answers = 0;  ///< given
  std::size_t trials = 0;   ///< total, or its upper limit
  Attendance attendance = Attendance::UnderWay;
  bool rehearsal = false;
  ResponseLine protocol;
};

/// Reads a participant's file. @return nothing if it is not a participant's file. @throws
/// InputError: as responses_from_text(); an incomplete first line.
std::optional<RosterEntry> roster_entry(std::string_view text, const std::string& file);

/// The .jsonl files in a folder, sorted by name. @throws InputError: no such folder.
std::vector<std::string> response_files_in(const std::string& folder);

/// Reads files and skips those that are not a participant's. @param faults receives the messages of
/// files that cannot be read; null: they are thrown as InputError.
std::vector<RosterEntry> read_roster(std::span<const std::string> files,
                                     std::vector<std::string>* faults = nullptr);

/// The entry of a participant, compared by study::spelling_key(); null if not found.
const RosterEntry* find_participant(std::span<const RosterEntry> roster, std::string_view id);

/// The entry that replaces this participant; null if not replaced.
const RosterEntry* replacement_of(std::span<const RosterEntry> roster, const RosterEntry& entry);

}  // namespace prostm
