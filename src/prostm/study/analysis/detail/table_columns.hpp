#pragma once
/// The columns of an answer table and their meaning.

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "prostm/core/text/names.hpp"
#include "prostm/study/analysis/detail/csv.hpp"

namespace prostm::study {

/// Meanings of a column (docs/study/study-files.md).
enum class Column : std::uint8_t {
  Participant,
  Method,
  Scene,
  Correct,
  Question,
  Answer,
  Trial,
  Level,
  Kind,
  Response,
  ResponseTime,
  Stimulus,
  Gate,
  Protocol,
  Version,
  Device,
  Array,
  Hand
};
inline constexpr std::size_t kColumns = 18;

}  // namespace prostm::study

template <>
inline constexpr std::array<std::string_view, prostm::study::kColumns>
    prostm::kNames<prostm::study::Column> = {"participant", "method",
                                             "scene",       "correct",
                                             "question",    "answer",
                                             "trial",       "level",
                                             "kind",        "response",
                                             "response_s",  "stimulus_checksum",
                                             "gate",        "protocol_checksum",
                                             "run_version", "run_device",
                                             "run_array",   "run_hand"};

namespace prostm::study {

/// The table's own column names, and values that apply to all rows.
struct ColumnMap {
  std::map<Column, std::string> named, constant;
};

/// Reads "correct=key_resp.corr,method:=am": NAME=COLUMN, or NAME:=VALUE for all rows.
/// @throws InputError: a name that is unknown or given twice, no "=".
ColumnMap column_map(std::string_view text);

/// A column of a table that has no meaning for the analysis.
struct OtherColumn {
  std::size_t place = 0;
  std::string name;      ///< unique, and not one of ours
  bool renamed = false;  ///< its name was one of ours, or empty
};

/// The positions of the columns in a table.
class ColumnPlaces {
 public:
  /// Names match without regard to case, blanks, "-" and "_"; an exact match is preferred.
  /// @throws InputError by csv.fail(): a column named in `map` is missing, or two columns match.
  ColumnPlaces(const std::vector<std::string>& header, const ColumnMap& map, const CsvReader& csv);

  /// Whether there is such a value, in a column or for all rows.
  bool has(Column column) const { return place(column) || is_constant(column); }
  bool is_constant(Column column) const { return map_.constant.contains(column); }
  std::optional<std::size_t> place(Column column) const {
    return places_[static_cast<std::size_t>(column)];
  }
  /// Returns the trimmed value of a row. @pre has(column), place(column) is within the row.
  std::string value(Column column, const std::vector<std::string>& row) const;
  /// @throws InputError by csv.fail(): a needed column is missing. The message lists the table's
  /// columns and suggests a value of --columns.
  void require(const std::vector<Column>& needed, const CsvReader& csv) const;
  std::size_t size() const { return header_.size(); }
  /// Returns the columns besides those in `kept`. A name that is one of ours, regardless of
  /// spelling, gets "_given", an empty one is "column_3", and a repeated one gets "_2", "_3", ….
  std::vector<OtherColumn> others(const std::vector<Column>& kept) const;

 private:
  std::string example(const std::vector<Column>& missing) const;

  std::vector<std::string> header_;
  const ColumnMap& map_;
  std::array<std::optional<std::size_t>, kColumns> places_;
};

/// Returns the separator for which the header contains most of the needed columns, and moves `text`
/// past a first line "sep=;".
char separator_of(std::string_view& text, const std::string& file, const ColumnMap& map);

}  // namespace prostm::study
