#include "files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "prostm/core/input_error.hpp"
#include "prostm/core/nearest_name.hpp"

namespace prostm::app {

void Files::reads(const std::string& option, const std::string& path,
                  std::vector<std::string> names) {
  entries_.push_back({option, path, check_readable, false, {}, std::move(names)});
}

void Files::writes(const std::string& option, const std::string& path, Check also,
                   const std::string& of) {
  entries_.push_back({option, path, also, true, of, {}});
}

void Files::check() const {
  for (const Entry& entry : entries_) {
    // an option that follows an option takes the place of its value
    if (entry.path.starts_with("--")) {
      throw InputError(fmt::format("{} needs the name of a file, and {} is an option", entry.option,
                                   entry.path));
    }
    if (entry.output) continue;
    try {
      entry.check(entry.path);
    } catch (const InputError& error) {
      throw InputError(error.what() + did_you_mean(entry.path, entry.names));
    }
  }
  for (const Entry& entry : entries_) {
    if (!entry.output) continue;
    for (const Entry& other : entries_) {
      const bool updated = !entry.of.empty() && !other.output && other.option.starts_with(entry.of);
      if (&other == &entry || updated) continue;
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

}  // namespace prostm::app
