#pragma once
/// The values of cells of answer tables, as spreadsheets and experiment software spell them.

#include <optional>
#include <string>
#include <string_view>

namespace prostm::study {

/// Whether a cell holds no value: it is blank, or NA, NaN, null, None, undefined, "-" or the like.
bool is_missing(std::string_view cell);

/// The same of a name, which "None" or "-" may be: it is blank, NA, NaN, null or undefined.
bool is_missing_name(std::string_view cell);

/// Returns whether a cell says yes: 1 or 0, true or false, yes or no, right or wrong, correct or
/// incorrect, or their first letters but r, w, c and i; TRUE and FALSE as Excel writes them in
/// German, French, Spanish, Italian, Portuguese and Dutch. Case does not matter. Nothing for
/// anything else.
std::optional<bool> yes_or_no(std::string_view cell);

/// The numbers of one column: all with a decimal point, or all with a decimal comma.
class NumberColumn {
 public:
  /// @param separator of the table. Where it is a comma or a tab, "1,250" may be 1250.
  explicit NumberColumn(char separator) : separator_(separator) {}

  /// Returns the number in a cell, or nothing with `problem` set to the end of a sentence that
  /// begins "it ": not a number, not finite, both decimal marks, an ambiguous comma.
  std::optional<double> read(std::string_view cell, std::string& problem);

 private:
  char separator_;
  char mark_ = '\0';  // of the cells before; 0: they had none
};

}  // namespace prostm::study
