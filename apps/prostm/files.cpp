#include "files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include "prostm/core/input_error.hpp"
#include "prostm/core/text/lower_case.hpp"

namespace prostm::app {

void Files::reads(const std::string& option, const std::string& path, std::string hint) {
  entries_.push_back({option, path, check_readable, false, {}, std::move(hint)});
}

void Files::writes(const std::string& option, const std::string& path, Check also,
                   const std::string& of) {
  entries_.push_back({option, path, also, true, of, {}});
}

void Files::check() const {
  std::string input;  // the option that takes standard input
  for (const Entry& entry : entries_) {
    // an option where the value of the option before is missing
    if (entry.path.starts_with("--")) {
      throw InputError(fmt::format("{} needs the name of a file, and {} is an option", entry.option,
                                   entry.path));
    }
    if (entry.path.empty()) {
      throw InputError(
          fmt::format("{} needs the name of a file, and the one given is empty", entry.option));
    }
    if (entry.output) continue;
    if (entry.path == "-") {
      if (!input.empty())
        throw InputError(fmt::format("{} and {} cannot both read standard input; name a file",
                                     input, entry.option));
      input = entry.option;
    }
    try {
      entry.check(entry.path);
    } catch (const InputError& error) {
      throw InputError(error.what() + entry.hint);
    }
  }
  for (const Entry& entry : entries_) {
    if (!entry.output) continue;
    for (const Entry& other : entries_) {
      const bool updated = !entry.of.empty() && !other.output && other.option.starts_with(entry.of);
      const bool both_ways = entry.path == "-" && !other.output;  // standard output and input
      if (&other == &entry || updated || both_ways) continue;
      if (!is_same_file(entry.path, other.path)) continue;
      throw InputError(
          fmt::format("{} {} and {} {} are one file, which would be overwritten; give {} another "
                      "name",
                      entry.option, entry.path, other.option, other.path, entry.option));
    }
    if (entry.check != nullptr) entry.check(entry.path);
  }
}

bool Files::any_output() const {
  return std::ranges::any_of(entries_, [](const Entry& e) { return e.output && e.path != "-"; });
}

void check_json_output(const std::string& path) {
  const std::string ending = lower_case(std::filesystem::path(path).extension().string());
  constexpr std::array kOthers = {".png", ".svg", ".pdf", ".csv", ".h5", ".npy", ".toml", ".jsonl"};
  if (std::ranges::find(kOthers, ending) != kOthers.end()) {
    throw InputError(fmt::format(
        "{} would hold JSON, and {} is another kind of file; end its name in .json", path, ending));
  }
  check_writable(path);
}

void check_csv_output(const std::string& path) {
  if (!path.ends_with(".csv")) throw InputError(path + " names no table; it must end in .csv");
  check_writable(path);
}

void check_pose_output(const std::string& path) {
  if (!path.ends_with(".json"))
    throw InputError(path + " names no pose file; it must end in .json, as --tracker takes it");
  check_writable(path);
}

}  // namespace prostm::app
