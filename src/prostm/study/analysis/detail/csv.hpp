#pragma once
/// Rows of separated values: RFC 4180 with any separator.

#include <string>
#include <string_view>
#include <vector>

namespace prostm::study {

/// Reads a text row by row. Empty lines are skipped; lines end in LF, CRLF or CR. Blanks around a
/// quoted value are no part of it.
class CsvReader {
 public:
  /// @param text without a byte order mark. @param file names the text in messages. Both must
  /// outlive the reader.
  CsvReader(std::string_view text, const std::string& file, char separator = ',');

  /// Puts the next row's values in place of `row`; false after the last. @throws InputError: a
  /// quote that is not closed or stands inside a value, a byte of no text.
  bool next(std::vector<std::string>& row);

  /// Throws "<file>, line <n>: <problem>" about the row that was read last.
  [[noreturn]] void fail(const std::string& problem) const;

  int line() const { return line_; }  ///< of the row that was read last, from 1
  /// Whether the first value of that row stood in quotes.
  bool began_quoted() const { return began_quoted_; }
  char separator() const { return separator_; }

 private:
  std::string value();
  std::string quoted();
  std::string plain();
  bool at_end() const { return at_ >= text_.size(); }
  bool at_line_end() const;
  bool at_value_end() const;
  void end_line();
  void skip_blanks();

  std::string_view text_;
  const std::string& file_;
  char separator_;
  bool began_quoted_ = false;
  std::size_t at_ = 0;
  int line_ = 0, next_line_ = 1;
};

}  // namespace prostm::study
