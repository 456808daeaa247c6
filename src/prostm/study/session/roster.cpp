#include "prostm/study/session/roster.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "prostm/core/file/file.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/study/session/spelling.hpp"
#include "prostm/study/task/line_keys.hpp"

namespace prostm {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{64} << 20;

/// The number that sets the orders, for a participant who replaces nobody.
int own_order(const std::string& participant) {
  int order = 0;
  std::from_chars(participant.data(), participant.data() + participant.size(), order);
  return order;
}

}  // namespace

std::optional<RosterEntry> roster_entry(std::string_view text, const std::string& file) {
  if (text.find(kResponseFormat) == std::string_view::npos) return {};
  const std::vector<ResponseLine> lines = responses_from_text(text, file);
  if (lines.empty() || lines.front().value(line::kFormat, "") != kResponseFormat) return {};
  const ResponseLine& first = lines.front();
  RosterEntry entry;
  entry.file = file;
  try {
    entry.participant = first.at(line::kParticipant);
    entry.replaces = first.value(line::kReplaces, "");
    entry.order = first.value(line::kOrder, own_order(entry.participant));
    entry.trials = first.at(line::kTrials);
    entry.rehearsal = first.at(line::kRun).at("rehearsal");
    entry.protocol = first.value(line::kProtocol, ResponseLine());
  } catch (const ResponseLine::exception& error) {
    throw InputError(fmt::format("{}, line 1: {}", file, error.what()));
  }
  for (const ResponseLine& line : lines) {
    const std::string kind = line.value(line::kKind, "");
    if (kind == line::kTrial) ++entry.answers;
    if (kind == line::kEnd) entry.attendance = Attendance::Complete;
    if (kind == line::kWithdrawn) entry.attendance = Attendance::Left;
  }
  return entry;
}

std::vector<std::string> response_files_in(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code wrong;
  for (const auto& file : std::filesystem::directory_iterator(folder, wrong))
    if (file.path().extension() == ".jsonl") files.push_back(file.path().string());
  if (wrong) throw InputError(fmt::format("{} cannot be read: {}", folder, wrong.message()));
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<RosterEntry> read_roster(std::span<const std::string> files,
                                     std::vector<std::string>* faults) {
  std::vector<RosterEntry> roster;
  for (const std::string& file : files) {
    try {
      auto entry = roster_entry(read_file(file, kMaxBytes, Empty::Allowed), file);
      if (entry) roster.push_back(std::move(*entry));
    } catch (const InputError& error) {
      if (faults == nullptr) throw;
      faults->emplace_back(error.what());
    }
  }
  return roster;
}

const RosterEntry* find_participant(std::span<const RosterEntry> roster, std::string_view id) {
  const std::string wanted = study::spelling_key(id);
  const auto found = std::find_if(roster.begin(), roster.end(), [&](const RosterEntry& e) {
    return study::spelling_key(e.participant) == wanted;
  });
  return found == roster.end() ? nullptr : &*found;
}

const RosterEntry* replacement_of(std::span<const RosterEntry> roster, const RosterEntry& entry) {
  const std::string replaced = study::spelling_key(entry.participant);
  const auto found = std::find_if(roster.begin(), roster.end(), [&](const RosterEntry& e) {
    return !e.replaces.empty() && study::spelling_key(e.replaces) == replaced;
  });
  return found == roster.end() ? nullptr : &*found;
}

}  // namespace prostm
