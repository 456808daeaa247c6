#include "prostm/core/text/nearest_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace prostm {
namespace {

/// Returns the number of edits (insert, delete, replace) that turn a into b.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, replaced});
    }
  }
  return row.back();
}

}  // namespace

std::string shown_name(std::string_view name) {
  return std::string(name.substr(0, 60));
}

std::optional<std::string> nearest_name(std::string_view unknown,
                                        const std::vector<std::string>& known) {
  const std::string typed = shown_name(unknown);
  // an abbreviation
  const auto begins = [&](const std::string& name) { return name.starts_with(typed); };
  constexpr std::size_t kShortest = 3;
  if (typed.size() >= kShortest && std::count_if(known.begin(), known.end(), begins) == 1)
    return *std::find_if(known.begin(), known.end(), begins);
  const auto nearest =
      std::min_element(known.begin(), known.end(), [&](const auto& a, const auto& b) {
        return edit_distance(typed, a) < edit_distance(typed, b);
      });
  if (nearest == known.end()) return std::nullopt;
  const std::size_t distance = edit_distance(typed, *nearest);
  const std::size_t tolerance = std::max<std::size_t>(2, nearest->size() / 3);
  // "foo" is not similar to "now": at most half of a short name may differ
  if (distance > tolerance || 2 * distance > nearest->size()) return std::nullopt;
  return *nearest;
}

std::string did_you_mean(std::string_view unknown, const std::vector<std::string>& known) {
  const auto nearest = nearest_name(unknown, known);
  return nearest ? fmt::format("; did you mean \"{}\"?", *nearest) : "";
}

std::string suggestion(std::string_view unknown, const std::vector<std::string>& known) {
  if (const auto nearest = nearest_name(unknown, known))
    return fmt::format("did you mean \"{}\"?", *nearest);
  if (known.empty()) return "no names are allowed here";
  return fmt::format("known are {}", fmt::join(known, ", "));
}

}  // namespace prostm
