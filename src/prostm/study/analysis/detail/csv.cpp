#include "prostm/study/analysis/detail/csv.hpp"

#include "prostm/core/input_error.hpp"

namespace prostm::study {

CsvReader::CsvReader(std::string_view text, const std::string& file, char separator)
    : text_(text), file_(file), separator_(separator) {}

bool CsvReader::next(std::vector<std::string>& row) {
  row.clear();
  while (!at_end() && at_line_end()) end_line();
  if (at_end()) return false;
  line_ = next_line_;
  began_quoted_ = text_[at_] == '"';
  while (true) {
    row.push_back(value());
    if (at_end()) return true;
    if (at_line_end()) {
      end_line();
      return true;
    }
    ++at_;  // a separator: another value follows
  }
}

void CsvReader::fail(const std::string& problem) const {
  throw InputError(file_ + ", line " + std::to_string(line_) + ": " + problem);
}

bool CsvReader::at_line_end() const {
  return text_[at_] == '\n' || text_[at_] == '\r';
}

bool CsvReader::at_value_end() const {
  return at_end() || text_[at_] == separator_ || at_line_end();
}

void CsvReader::end_line() {
  at_ += text_.substr(at_, 2) == "\r\n" ? 2 : 1;
  ++next_line_;
}

void CsvReader::skip_blanks() {
  while (!at_value_end() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
}

std::string CsvReader::value() {
  const std::size_t begin = at_;
  skip_blanks();
  if (!at_end() && text_[at_] == '"') return quoted();
  at_ = begin;
  return plain();
}

std::string CsvReader::quoted() {
  std::string value;
  for (++at_; !at_end(); ++at_) {
    if (text_[at_] != '"') {
      next_line_ += text_[at_] == '\n' ? 1 : 0;
      value += text_[at_];
      continue;
    }
    ++at_;
    if (!at_end() && text_[at_] == '"') {
      value += '"';
      continue;
    }
    skip_blanks();
    if (at_value_end()) return value;
    fail("a quoted value continues after its closing quote");
  }
  fail("a quote is not closed; the file may be cut off");
}

std::string CsvReader::plain() {
  const std::size_t begin = at_;
  for (; !at_value_end(); ++at_) {
    const auto byte = static_cast<unsigned char>(text_[at_]);
    if (byte == '"') fail("a quote stands inside a value that does not begin with one");
    if (byte < 0x20 && byte != '\t') fail("has a control character, so this is not a text file");
  }
  return std::string(text_.substr(begin, at_ - begin));
}

}  // namespace prostm::study
