#pragma once
/// Parses cells of answer tables as written by spreadsheets and experiment software.

#include <optional>
#include <string>
#include <string_view>

namespace prostm::study {

/// Whether a cell has no value: it is blank, or NA, NaN, null, None, undefined, "-" or similar.
bool is_missing(std::string_view cell);

/// Whether a name is missing: it is blank, NA, NaN, null or undefined. ("None" and "-" are valid
/// names.)
bool is_missing_name(std::string_view cell);

/// Reads a yes/no value: 1 or 0, true or false, yes or no, right or wrong, correct or incorrect, or
/// their first letters except r, w, c and i; TRUE and FALSE as Excel writes them in German, French,
/// Spanish, Italian, Portuguese and Dutch. Case is ignored. Returns nothing for any other text.
std::optional<bool> yes_or_no(std::string_view cell);

/// Reads the numbers of one column: all with a decimal point, or all with a decimal comma.
class NumberColumn {
 public:
  /// @param separator the separator of the table. If it is a comma or a tab, "1,250" may mean 1250.
  explicit NumberColumn(char separator) : separator_(separator) {}

  /// Returns the number in a cell. On failure, returns nothing and sets `problem` to the end of a
  /// sentence beginning with "it ": not a number, not finite, both decimal marks, an ambiguous
  /// comma.
  std::optional<double> read(std::string_view cell, std::string& problem);

 private:
  char separator_;
  char mark_ = '\0';  // decimal mark of earlier cells; 0: none so far
};

}  // namespace prostm::study
