#include "prostm/study/analysis/detail/cells.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "prostm/study/session/spelling.hpp"

namespace prostm::study {
namespace {

template <std::size_t N>
bool is_in(const std::array<std::string_view, N>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

constexpr std::array<std::string_view, 6> kMissingNames = {"",     "na",  "n/a",
                                                           "null", "nan", "undefined"};
constexpr std::array<std::string_view, 9> kMissing = {
    "none", "nil", "-", ".", "#n/a", "missing", "<na>", "n.a.", "no-response"};
constexpr std::array<std::string_view, 15> kYes = {
    "1",  "true", "yes", "t",    "y",         "right",      "correct", "wahr",
    "ja", "vrai", "oui", "vero", "verdadero", "verdadeiro", "waar"};
constexpr std::array<std::string_view, 14> kNo = {"0",     "false",     "no",     "f",    "n",
                                                  "wrong", "incorrect", "falsch", "nein", "faux",
                                                  "non",   "falso",     "onwaar", "nee"};

/// Whether the only comma of a number may be a thousands separator: "1,250".
bool may_group_thousands(std::string_view cell) {
  if (cell.starts_with('-')) cell.remove_prefix(1);
  const std::size_t comma = cell.find(',');
  return comma >= 1 && comma <= 3 && cell.front() != '0' && cell.size() == comma + 4;
}

}  // namespace

bool is_missing_name(std::string_view cell) {
  return is_in(kMissingNames, spelling_key(cell));
}

bool is_missing(std::string_view cell) {
  const std::string key = spelling_key(cell);
  return is_in(kMissingNames, key) || is_in(kMissing, key);
}

std::optional<bool> yes_or_no(std::string_view cell) {
  const std::string key = spelling_key(cell);
  if (is_in(kYes, key)) return true;
  if (is_in(kNo, key)) return false;
  return std::nullopt;
}

std::optional<double> NumberColumn::read(std::string_view cell, std::string& problem) {
  std::string text = trimmed(cell);
  const auto fail = [&](const char* why) {
    problem = why;
    return std::nullopt;
  };
  const auto commas = std::count(text.begin(), text.end(), ',');
  const char mark = commas == 1 ? ',' : text.find('.') != std::string::npos ? '.' : '\0';
  if (mark == ',' && separator_ != ';' && may_group_thousands(text))
    return fail(
        "is ambiguous: the comma may be decimal or separate thousands; write it with a decimal "
        "point");
  if (mark == ',') text[text.find(',')] = '.';
  double value = 0.0;
  const char *begin = text.data() + (text.starts_with('+') ? 1 : 0),
             *end = text.data() + text.size();
  const auto [at, error] = std::from_chars(begin, end, value);
  if (error != std::errc() || at != end || begin == end || !std::isfinite(value))
    return fail("must be a number");
  if (mark != '\0' && mark_ != '\0' && mark != mark_)
    return fail("has another decimal mark than earlier rows");
  if (mark != '\0') mark_ = mark;
  return value + 0.0;  // −0 becomes 0
}

}  // namespace prostm::study
