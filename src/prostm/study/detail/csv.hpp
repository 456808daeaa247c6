#pragma once
/// Rows of comma-separated values (RFC 4180).

#include <string>
#include <string_view>
#include <vector>

namespace prostm::study {

/// Reads a text row by row. Empty lines are skipped; lines end in LF or CRLF.
class CsvReader {
 public:
  /// @param file names the text in messages. Both must outlive the reader.
  CsvReader(std::string_view text, const std::string& file);

  /// Puts the next row's values in place of `row`; false after the last. @throws InputError: a
  /// quote that is not closed or stands inside a value, a byte of no text.
  bool next(std::vector<std::string>& row);

  /// Throws "<file>, line <n>: <problem>" about the row that was read last.
  [[noreturn]] void fail(const std::string& problem) const;

 private:
  std::string quoted();
  std::string plain();
  bool at_end() const { return at_ >= text_.size(); }
  bool at_line_end() const;
  void end_line();

  std::string_view text_;
  const std::string& file_;
  std::size_t at_ = 0;
  int line_ = 0, next_line_ = 1;
};

}  // namespace prostm::study
