#pragma once
/// Reads rows of separated values: RFC 4180 with any separator.

#include <string>
#include <string_view>
#include <vector>

namespace prostm::study {

/// Reads a text row by row. Empty lines are skipped; lines end in LF, CRLF or CR. Blanks around a
/// quoted value are ignored.
class CsvReader {
 public:
  /// @param text without a byte order mark. @param file names the text in messages. Both must
  /// outlive the reader.
  CsvReader(std::string_view text, const std::string& file, char separator = ',');

  /// Replaces `row` by the values of the next row; false after the last. @throws InputError: an
  /// unclosed quote, a quote inside a value, a control character.
  bool next(std::vector<std::string>& row);

  /// Throws "<file>, line <n>: <problem>" about the last row read.
  [[noreturn]] void fail(const std::string& problem) const;

  int line() const { return line_; }  ///< line of the last row read, from 1
  /// Whether the first value of the last row was quoted.
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
