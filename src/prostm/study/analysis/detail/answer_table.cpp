#include "prostm/study/analysis/detail/answer_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "prostm/core/input_error.hpp"
#include "prostm/core/text/nearest_name.hpp"
#include "prostm/study/analysis/detail/cells.hpp"
#include "prostm/study/analysis/detail/csv.hpp"
#include "prostm/study/analysis/detail/table_columns.hpp"
#include "prostm/study/session/spelling.hpp"

namespace prostm::study {
namespace {

std::string in_quotes(const std::string& name) {
  return '"' + shown_name(name) + '"';
}

/// "line 5", or "lines 5, 6, 9 and 12 more".
std::string lines_text(const std::vector<int>& lines) {
  constexpr std::size_t kMostShown = 3;
  std::string out = lines.size() == 1 ? "line " : "lines ";
  for (std::size_t i = 0; i < std::min(lines.size(), kMostShown); ++i)
    out += (i == 0 ? "" : ", ") + std::to_string(lines[i]);
  if (lines.size() > kMostShown) out += fmt::format(" and {} more", lines.size() - kMostShown);
  return out;
}

/// Names in a column that appear both with and without white space around them.
class Trims {
 public:
  void add(const std::string& name, const std::string& written) { written_[name].insert(written); }
  void note(std::string_view column, const std::string& file,
            std::vector<std::string>& notes) const {
    std::string names;
    for (const auto& [name, written] : written_) {
      if (written.size() > 1) names += (names.empty() ? "" : ", ") + in_quotes(name);
    }
    if (names.empty()) return;
    notes.push_back(
        fmt::format("{}: {} {}: written with and without white space around it; treated as "
                    "one name.",
                    file, column, names));
  }

 private:
  std::map<std::string, std::set<std::string>> written_;
};

class TableReader {
 public:
  TableReader(std::string_view text, const std::string& file, char separator, const ColumnMap& map,
              std::vector<std::string>& notes)
      : file_(file),
        csv_(text, file, separator),
        levels_(separator),
        times_(separator),
        notes_(notes),
        places_(header(), map, csv_) {}

  std::vector<Answer> read();

 private:
  struct Row {
    int line = 0;
    std::size_t hash = 0;  // of all cells
    std::vector<std::string> cells;
  };

  std::vector<std::string> header();
  void read_rows();
  void fit_to_header(std::vector<std::string>& row) const;
  void choose_columns();
  void leave_out(Column column) { left_out_.insert(column); }
  bool has(Column column) const { return places_.has(column) && !left_out_.contains(column); }
  std::string text(Column column, const Row& row) const {
    return has(column) ? places_.value(column, row.cells) : std::string();
  }
  [[noreturn]] void fail(const Row& row, const std::string& problem) const {
    throw InputError(fmt::format("{}, line {}: {}", file_, row.line, problem));
  }
  bool has_answer(const Row& row) const;
  bool is_no_trial(const Row& row, bool answered);
  std::string name(const Row& row, Column column);
  bool yes(const Row& row, Column column) const;
  double level(const Row& row);
  AnswerKind kind(const Row& row);
  void read_question(const Row& row, Answer& out) const;
  void check_trial(const Row& row, const Answer& answer);
  void read_facts(const Row& row, Answer& out);
  std::optional<Answer> answer(const Row& row);
  bool keeps(Column column) const;
  void keep_others(const std::vector<std::size_t>& rows, std::vector<Answer>& out);
  void write_notes();

  const std::string& file_;
  CsvReader csv_;
  bool header_quoted_ = false, adjusted_ = false;  // adjusted_: the kind is Adjusted
  bool odd_times_ = false;                         // a response time is not a number
  NumberColumn levels_, times_;
  std::vector<std::string>& notes_;
  ColumnPlaces places_;
  std::set<Column> left_out_;
  std::vector<Row> rows_;
  std::optional<AnswerKind> all_of_;
  std::map<Column, Trims> trims_;
  std::map<std::pair<std::string, std::string>, std::set<std::size_t>> trials_;
  std::set<std::string> repeating_;  // participants with repeated trial numbers
  std::vector<int> no_trials_;       // line numbers of rows that are not trials
};

std::vector<std::string> TableReader::header() {
  std::vector<std::string> row;
  if (!csv_.next(row)) throw InputError(file_ + ": has no header");
  header_quoted_ = csv_.began_quoted();
  return row;
}

/// Makes a row as long as the header. R writes quoted row names without a header.
void TableReader::fit_to_header(std::vector<std::string>& row) const {
  const std::size_t wanted = places_.size();
  const auto is_blank = [](const std::string& cell) { return trimmed(cell).empty(); };
  const bool has_row_name =
      row.size() == wanted + 1 && header_quoted_ && csv_.began_quoted() && !is_blank(row.back());
  if (has_row_name) row.erase(row.begin());
  while (row.size() > wanted && is_blank(row.back())) row.pop_back();
  std::size_t needed = 0;  // number of cells that are read
  for (std::size_t i = 0; i < kColumns; ++i) {
    if (const auto place = places_.place(static_cast<Column>(i)))
      needed = std::max(needed, *place + 1);
  }
  if (row.size() <= wanted && row.size() >= needed) return row.resize(wanted);
  csv_.fail(fmt::format("has {} columns instead of the header's {}{}", row.size(), wanted,
                        row.size() > wanted && csv_.separator() == ','
                            ? "; decimal commas need another separator, or quotes"
                            : ""));
}

void TableReader::read_rows() {
  std::vector<std::string> cells;
  while (csv_.next(cells)) {
    std::size_t hash = 0;
    for (const std::string& cell : cells) hash = 31 * hash + std::hash<std::string>()(cell);
    const auto is_blank = [](const std::string& cell) { return trimmed(cell).empty(); };
    if (std::all_of(cells.begin(), cells.end(), is_blank))
      continue;  // empty rows left by spreadsheets
    fit_to_header(cells);
    rows_.push_back({csv_.line(), hash, cells});
  }
}

/// Ignores columns that have one of our names but hold something else.
void TableReader::choose_columns() {
  std::set<std::string> scenes, questions;
  bool has_response = false;
  for (const Row& row : rows_) {
    has_response = has_response || !is_missing(text(Column::Response, row));
    const auto is_named = [&](Column column) { return !is_missing_name(text(column, row)); };
    if (!is_named(Column::Participant) || !is_named(Column::Method) || !is_named(Column::Scene))
      continue;
    scenes.insert(text(Column::Scene, row));
    questions.insert(text(Column::Question, row));
  }
  if (!has_response) leave_out(Column::Response);
  const bool both = has(Column::Question) && has(Column::Answer);
  const bool ask_for_scenes = std::any_of(
      questions.begin(), questions.end(),
      [&](const std::string& question) { return !question.empty() && scenes.contains(question); });
  if (both && ask_for_scenes) return;
  if (has(Column::Question) || has(Column::Answer)) {
    notes_.push_back(file_ +
                     (both ? ": the column \"question\" names no scene; it and \"answer\" are "
                             "not read."
                           : ": question and answer belong together, and one of the columns "
                             "is missing; the other one is not read."));
  }
  leave_out(Column::Question);
  leave_out(Column::Answer);
}

bool TableReader::has_answer(const Row& row) const {
  if (adjusted_) return !is_missing(text(Column::Level, row));
  for (const Column column : {Column::Correct, Column::Response, Column::Answer}) {
    if (has(column) && is_missing(text(column, row))) return false;
  }
  return true;
}

/// Whether a row belongs to an instruction, a break or another routine: it has no condition, or
/// neither an answer nor a complete condition.
bool TableReader::is_no_trial(const Row& row, bool answered) {
  int missing = 0, of = 0;
  for (const Column column : {Column::Method, Column::Scene}) {
    if (places_.is_constant(column)) continue;
    ++of;
    missing += is_missing_name(text(column, row)) ? 1 : 0;
  }
  if (of > 0 && missing == of) return true;
  return !answered && (missing > 0 || is_missing_name(text(Column::Participant, row)));
}

std::string TableReader::name(const Row& row, Column column) {
  const std::string value = text(column, row);
  if (is_missing_name(value)) fail(row, std::string(name_of(column)) + " is empty");
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20; };
  if (std::any_of(value.begin(), value.end(), is_control))
    fail(row, std::string(name_of(column)) + " contains a line break or another control character");
  if (const auto place = places_.place(column)) trims_[column].add(value, row.cells[*place]);
  return value;
}

bool TableReader::yes(const Row& row, Column column) const {
  const std::string value = text(column, row);
  if (const auto is_yes = yes_or_no(value)) return *is_yes;
  fail(row, fmt::format("{} is {}: it must be 0 or 1, true or false, or yes or no", name_of(column),
                        in_quotes(value)));
}

double TableReader::level(const Row& row) {
  constexpr double kLeast = 1e-9, kMost = 1e9;  // so that fits stay finite
  const std::string value = text(Column::Level, row);
  std::string problem = "must be a number in every row, 0 or from 1e-9 to 1e9 in size";
  std::string why;
  const auto x = levels_.read(value, why);
  if (x && (*x == 0.0 || (std::abs(*x) >= kLeast && std::abs(*x) <= kMost))) return *x;
  if (!x && why != "must be a number") problem = why;
  fail(row, fmt::format("level is {}: it {}", in_quotes(value), problem));
}

AnswerKind TableReader::kind(const Row& row) {
  const std::string value = text(Column::Kind, row);
  const auto kind = value_named<AnswerKind>(value);
  if (!kind) fail(row, "kind " + must_be(value, kNames<AnswerKind>));
  if (*kind != AnswerKind::Right && !has(Column::Level))
    fail(row, "kind is \"" + value + "\", but the header has no column \"level\"");
  if (all_of_.value_or(*kind) != *kind)
    fail(row, "kind is \"" + value + "\", but earlier rows have another kind");
  all_of_ = kind;
  return *kind;
}

void TableReader::read_question(const Row& row, Answer& out) const {
  if (out.question.empty()) fail(row, "question is empty");
  out.yes = yes(row, Column::Answer);
  if (out.correct == ((out.question == out.scene) == out.yes)) return;
  fail(row,
       fmt::format("correct is {}, but the answer {} to the question {} is {} where the scene is "
                   "{}",
                   out.correct ? 1 : 0, out.yes ? 1 : 0, in_quotes(out.question),
                   out.correct ? "wrong" : "right", in_quotes(out.scene)));
}

/// Refuses a copied row: equal in all cells, including the trial number.
void TableReader::check_trial(const Row& row, const Answer& answer) {
  if (answer.trial.empty()) return;
  auto& same = trials_[{answer.participant, answer.trial}];
  if (!same.insert(row.hash).second) {
    fail(row, fmt::format("participant {} has trial {} twice", in_quotes(answer.participant),
                          shown_name(answer.trial)));
  }
  if (same.size() > 1) repeating_.insert(answer.participant);
}

void TableReader::read_facts(const Row& row, Answer& out) {
  std::string ignored;
  if (has(Column::ResponseTime)) {
    const std::string time = text(Column::ResponseTime, row);
    out.response_s = times_.read(time, ignored);
    odd_times_ = odd_times_ || (!out.response_s && !is_missing(time));
  }
  out.gate = text(Column::Gate, row);
  out.stimulus = text(Column::Stimulus, row);
  out.run = {text(Column::Protocol, row), text(Column::Version, row), text(Column::Device, row),
             text(Column::Array, row), text(Column::Hand, row)};
}

std::optional<Answer> TableReader::answer(const Row& row) {
  Answer out;
  out.answered = has_answer(row);
  if (is_no_trial(row, out.answered)) {
    no_trials_.push_back(row.line);
    return std::nullopt;
  }
  out.participant = name(row, Column::Participant);
  out.method = name(row, Column::Method);
  out.scene = name(row, Column::Scene);
  out.trial = text(Column::Trial, row);
  if (has(Column::Kind) && (out.answered || !is_missing(text(Column::Kind, row))))
    out.kind = kind(row);
  if (has(Column::Level) && (out.answered || !is_missing(text(Column::Level, row))))
    out.level = level(row);
  if (out.answered && !adjusted_) out.correct = yes(row, Column::Correct);
  out.question = text(Column::Question, row);
  if (has(Column::Question) && out.answered) read_question(row, out);
  read_facts(row, out);
  check_trial(row, out);
  return out;
}

/// Whether the answers have all that the cells of a column say.
bool TableReader::keeps(Column column) const {
  if (column == Column::Response || (column == Column::Correct && adjusted_)) return false;
  if (column == Column::Trial && !repeating_.empty()) return false;
  return has(column) && !(column == Column::ResponseTime && odd_times_);
}

/// Adds the other columns. @param rows places of the answers' rows.
void TableReader::keep_others(const std::vector<std::size_t>& rows, std::vector<Answer>& out) {
  std::vector<Column> kept;
  for (std::size_t i = 0; i < kColumns; ++i) {
    if (keeps(static_cast<Column>(i))) kept.push_back(static_cast<Column>(i));
  }
  for (const OtherColumn& of : places_.others(kept)) {
    const auto is_blank = [&](std::size_t row) {
      return trimmed(rows_[row].cells[of.place]).empty();
    };
    if (of.renamed && std::all_of(rows.begin(), rows.end(), is_blank)) continue;
    for (std::size_t i = 0; i < rows.size(); ++i)
      out[i].other.emplace_back(of.name, std::move(rows_[rows[i]].cells[of.place]));
  }
}

void TableReader::write_notes() {
  for (const auto& [column, trims] : trims_) trims.note(name_of(column), file_, notes_);
  if (!no_trials_.empty()) {
    notes_.push_back(
        fmt::format("{}: {} of {} rows have no method and scene, or neither these nor an "
                    "answer ({}), and are not taken as trials.",
                    file_, no_trials_.size(), rows_.size(), lines_text(no_trials_)));
  }
  if (!repeating_.empty()) {
    notes_.push_back(
        fmt::format("{}: trial numbers repeat for participant {}{} and are ignored there.", file_,
                    in_quotes(*repeating_.begin()), repeating_.size() > 1 ? " and others" : ""));
  }
}

std::vector<Answer> TableReader::read() {
  std::vector<Column> needed = {Column::Participant, Column::Method, Column::Scene};
  if (!has(Column::Kind)) needed.push_back(Column::Correct);
  places_.require(needed, csv_);
  read_rows();
  const auto is_adjusted = [&](const Row& row) {
    return text(Column::Kind, row) == name_of(AnswerKind::Adjusted);
  };
  adjusted_ = has(Column::Kind) && std::any_of(rows_.begin(), rows_.end(), is_adjusted);
  if (!adjusted_) places_.require({Column::Correct}, csv_);
  choose_columns();
  std::vector<Answer> out;
  std::vector<std::size_t> of_answers;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    auto of_row = answer(rows_[i]);
    if (!of_row) continue;
    out.push_back(std::move(*of_row));
    of_answers.push_back(i);
  }
  const auto is_answered = [](const Answer& a) { return a.answered; };
  if (std::none_of(out.begin(), out.end(), is_answered))
    throw InputError(file_ + ": has a header but no answers");
  for (Answer& a : out) {
    a.kind = all_of_.value_or(AnswerKind::Right);
    if (repeating_.contains(a.participant)) a.trial.clear();
  }
  keep_others(of_answers, out);
  write_notes();
  return out;
}

}  // namespace

std::vector<Answer> read_answer_table(std::string_view text, const std::string& file,
                                      const std::string& columns, std::vector<std::string>& notes) {
  const ColumnMap map = column_map(columns);
  const char separator = separator_of(text, file, map);
  return TableReader(text, file, separator, map, notes).read();
}

}  // namespace prostm::study
