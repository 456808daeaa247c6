#include "prostm/study/analysis/detail/table_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "prostm/core/input_error.hpp"
#include "prostm/core/text/nearest_name.hpp"
#include "prostm/study/session/spelling.hpp"

namespace prostm::study {
namespace {

/// Names of the needed columns in other programs, used to suggest --columns.
constexpr std::array<std::pair<Column, std::string_view>, 22> kOthersNames = {{
    {Column::Participant, "subject"},
    {Column::Participant, "subj"},
    {Column::Participant, "id"},
    {Column::Participant, "subject-id"},
    {Column::Participant, "participant-id"},
    {Column::Participant, "pid"},
    {Column::Participant, "session"},
    {Column::Method, "condition"},
    {Column::Method, "cond"},
    {Column::Method, "group"},
    {Column::Method, "technique"},
    {Column::Scene, "stimulus"},
    {Column::Scene, "stim"},
    {Column::Scene, "item"},
    {Column::Scene, "target"},
    {Column::Correct, "key-resp.corr"},
    {Column::Correct, "corr"},
    {Column::Correct, "accuracy"},
    {Column::Correct, "acc"},
    {Column::Correct, "is-correct"},
    {Column::Correct, "response.corr"},
    {Column::Correct, "score"},
}};

std::vector<std::string> known_names() {
  return {kNames<Column>.begin(), kNames<Column>.end()};
}

/// Whether a text begins with a line "sep=;", which Excel reads and writes. @param size receives
/// the length of the line without its end.
bool names_separator(std::string_view text, std::size_t& size) {
  constexpr std::string_view kSep = "sep=";
  const std::size_t begin = text.starts_with('"') ? 1 : 0;
  if (text.size() < begin + kSep.size() + 1) return false;
  if (spelling_key(text.substr(begin, kSep.size())) != kSep) return false;
  size = std::min(text.find_first_of("\r\n"), text.size());
  return size == begin + kSep.size() + 1 + begin;
}

}  // namespace

ColumnMap column_map(std::string_view text) {
  ColumnMap map;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(','), text.size());
    const std::string entry(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::size_t equals = entry.find('=');
    const bool is_constant = equals != std::string::npos && equals > 0 && entry[equals - 1] == ':';
    const std::string name =
        trimmed(entry.substr(0, std::min(equals, entry.size()) - (is_constant ? 1 : 0)));
    const std::string value =
        equals == std::string::npos ? std::string() : trimmed(entry.substr(equals + 1));
    if (value.empty()) {
      throw InputError(
          "--columns has \"" + shown_name(entry) +
          "\"; give NAME=COLUMN, e.g. correct=key_resp.corr, or NAME:=VALUE for all rows");
    }
    const auto column = value_named<Column>(name);
    if (!column) throw InputError("--columns: " + must_be(name, kNames<Column>));
    auto& into = is_constant ? map.constant : map.named;
    if (map.named.contains(*column) || map.constant.contains(*column))
      throw InputError("--columns gives " + name + " twice");
    into[*column] = value;
  }
  return map;
}

ColumnPlaces::ColumnPlaces(const std::vector<std::string>& header, const ColumnMap& map,
                           const CsvReader& csv)
    : header_(header), map_(map) {
  std::vector<std::string> keys;
  for (std::string& name : header_) {
    name = trimmed(name);
    keys.push_back(spelling_key(name));
  }
  for (std::size_t i = 0; i < kColumns; ++i) {
    const auto column = static_cast<Column>(i);
    if (is_constant(column)) continue;
    const auto given = map.named.find(column);
    const std::string name(given == map.named.end() ? name_of(column) : given->second);
    const auto find = [&](const std::vector<std::string>& names, const std::string& wanted) {
      const auto at = std::find(names.begin(), names.end(), wanted);
      if (at == names.end()) return false;
      if (std::find(at + 1, names.end(), wanted) != names.end())
        csv.fail("the column \"" + shown_name(name) + "\" appears twice");
      places_[i] = static_cast<std::size_t>(at - names.begin());
      return true;
    };
    if (find(header_, name) || find(keys, spelling_key(name)) || given == map.named.end()) continue;
    csv.fail("the header has no column \"" + shown_name(name) + "\", which --columns names" +
             did_you_mean(name, header_));
  }
}

std::string ColumnPlaces::value(Column column, const std::vector<std::string>& row) const {
  if (const auto at = map_.constant.find(column); at != map_.constant.end()) return at->second;
  return trimmed(row[*place(column)]);
}

void ColumnPlaces::require(const std::vector<Column>& needed, const CsvReader& csv) const {
  std::vector<Column> missing;
  for (const Column column : needed) {
    if (!has(column)) missing.push_back(column);
  }
  if (missing.empty()) return;
  std::string columns;
  constexpr std::size_t kMostShown = 12;
  for (std::size_t i = 0; i < std::min(header_.size(), kMostShown); ++i)
    columns += (i == 0 ? "\"" : ", \"") + shown_name(header_[i]) + '"';
  if (header_.size() > kMostShown) columns += ", …";
  csv.fail(
      fmt::format("the header has no column \"{}\": participant, method, scene and correct are "
                  "needed, but it has {}; name them with --columns {}",
                  name_of(missing.front()), columns, example(missing)));
}

std::vector<OtherColumn> ColumnPlaces::others(const std::vector<Column>& kept) const {
  std::set<std::size_t> without;
  for (const Column column : kept) {
    if (const auto at = place(column)) without.insert(*at);
  }
  std::vector<OtherColumn> out;
  for (std::size_t i = 0; i < header_.size(); ++i) {
    if (without.contains(i)) continue;
    const bool is_ours = std::any_of(
        kNames<Column>.begin(), kNames<Column>.end(),
        [&](std::string_view ours) { return spelling_key(ours) == spelling_key(header_[i]); });
    const std::string name = header_[i].empty() ? fmt::format("column_{}", i + 1)
                                                : header_[i] + (is_ours ? "_given" : "");
    out.push_back({i, name, is_ours || header_[i].empty()});
  }
  std::set<std::string> taken;
  for (const bool renamed : {false, true}) {  // names of the table before ours
    for (OtherColumn& of : out) {
      if (of.renamed != renamed) continue;
      const std::string name = of.name;
      for (int n = 2; !taken.insert(of.name).second; ++n) of.name = fmt::format("{}_{}", name, n);
    }
  }
  return out;
}

std::string ColumnPlaces::example(const std::vector<Column>& missing) const {
  std::string out;
  for (const Column column : missing) {
    std::string found = "COLUMN";
    for (const auto& [meaning, others] : kOthersNames) {
      if (meaning != column) continue;
      const auto at = std::find_if(
          header_.begin(), header_.end(),
          [&, key = others](const std::string& name) { return spelling_key(name) == key; });
      if (at != header_.end()) found = *at;
    }
    out += fmt::format("{}{}={}", out.empty() ? "" : ",", name_of(column), found);
  }
  return out;
}

char separator_of(std::string_view& text, const std::string& file, const ColumnMap& map) {
  std::size_t size = 0;
  if (names_separator(text, size)) {
    const char named = text[size - 1 - (text.starts_with('"') ? 1 : 0)];
    text.remove_prefix(size);
    return named;
  }
  const std::size_t first = text.find_first_not_of("\r\n");
  const std::string_view body = text.substr(std::min(first, text.size()));
  char best = ',';
  std::size_t most = 0;
  for (const char separator : {',', ';', '\t', '|'}) {
    std::vector<std::string> header;
    CsvReader csv(body, file, separator);
    try {
      if (!csv.next(header)) continue;
    } catch (const InputError&) {
      continue;  // quotes do not enclose the values with this separator
    }
    std::size_t found = header.size() > 1 ? 1 : 0;
    for (const std::string& name : header) {
      const auto is_wanted = [&](const std::string& wanted) {
        return spelling_key(name) == spelling_key(wanted);
      };
      const auto known = known_names();
      found += std::any_of(known.begin(), known.end(), is_wanted) ||
                       std::any_of(map.named.begin(), map.named.end(),
                                   [&](const auto& of) { return is_wanted(of.second); })
                   ? kColumns
                   : 0;
    }
    if (found > most) most = found, best = separator;
  }
  return best;
}

}  // namespace prostm::study
