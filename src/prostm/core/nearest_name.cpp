#include "prostm/core/nearest_name.hpp"

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

std::string suggestion(std::string_view unknown, const std::vector<std::string>& known) {
  const std::string typed = shown_name(unknown);
  const auto nearest =
      std::min_element(known.begin(), known.end(), [&](const auto& a, const auto& b) {
        return edit_distance(typed, a) < edit_distance(typed, b);
      });
  if (nearest == known.end()) return "no names are allowed here";
  const std::size_t tolerance = std::max<std::size_t>(2, nearest->size() / 3);
  if (edit_distance(typed, *nearest) <= tolerance)
    return fmt::format("did you mean \"{}\"?", *nearest);
  return fmt::format("known are {}", fmt::join(known, ", "));
}

}  // namespace prostm
