#include "prostm/study/analysis/scores.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "prostm/core/file/file.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/text/json.hpp"
#include "prostm/study/analysis/detail/answer_table.hpp"
#include "prostm/study/analysis/detail/identities.hpp"
#include "prostm/study/analysis/detail/response_answers.hpp"
#include "prostm/study/analysis/detail/same_stimuli.hpp"
#include "prostm/study/analysis/detail/table_columns.hpp"
#include "prostm/study/analysis/detail/text_encoding.hpp"
#include "prostm/study/session/roster.hpp"

namespace prostm {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{64} << 20;

/// One method of the paper's study.
struct PaperMethod {
  const char* key;
  const char* method;
};
constexpr std::array kPaperMethods = {PaperMethod{"AM", "am"}, PaperMethod{"STM", "pro-stm"}};
/// One scene of the paper's study.
struct PaperScene {
  const char* key;
  const char* scene;
};
constexpr std::array kPaperScenes = {PaperScene{"_1plume", "one-plume"},
                                     PaperScene{"_4plume", "four-plumes"}};

/// Adds the answers of all participants with one method.
void add_paper_method(const JsonNode& figure, const PaperMethod& of, int trials,
                      std::vector<Answer>& out) {
  const auto column = [&](const char* key) {
    return figure.at((std::string(of.key) + key).c_str(), "an array, right answers of each person");
  };
  const JsonNode all = column("_correct");
  for (std::size_t person = 0; person < all.array_size(); ++person) {
    int right = 0;
    for (const PaperScene& scene : kPaperScenes) {
      const JsonNode counts = column(scene.key);
      if (counts.array_size() != all.array_size())
        counts.fail("must have one number for each participant");
      const int correct = counts.at(person).integer(0, trials / 2);
      for (int trial = 0; trial < trials / 2; ++trial) {
        Answer answer;
        answer.participant = std::string(of.method) + '-' + std::to_string(person + 1);
        answer.method = of.method;
        answer.scene = scene.scene;
        answer.correct = trial < correct;
        out.push_back(answer);
      }
      right += correct;
    }
    if (right != all.at(person).integer(0, trials))
      all.at(person).fail("must be the sum of both scenes, " + std::to_string(right));
  }
}

}  // namespace

std::vector<Answer> answers_from_csv(std::string_view text, const std::string& file,
                                     const std::string& columns, std::vector<std::string>* notes) {
  const study::DecodedText decoded = study::decode_text(text, file);
  std::vector<std::string> said;
  if (!decoded.assumed.empty()) {
    said.push_back(
        fmt::format("{} is not UTF-8 and is read as {}; if letters are wrong, save it as "
                    "CSV in UTF-8.",
                    file, decoded.assumed));
  }
  std::vector<Answer> answers = study::read_answer_table(decoded.text, file, columns, said);
  if (notes != nullptr) notes->insert(notes->end(), said.begin(), said.end());
  return answers;
}

std::vector<Answer> answers_from_paper(std::string_view text, const std::string& file) {
  const nlohmann::json document = parse_json(text, file);
  const JsonNode root(document, file);
  const JsonNode figure = root.at("fig4", "the scores of the paper's Fig. 4");
  constexpr int kMost = 1000;
  const JsonNode trials = figure.at("trials_per_participant", "an even number of trials");
  const int count = trials.integer(2, kMost);
  if (count % 2 != 0) trials.fail("must be even: half of the trials had each scene");
  std::vector<Answer> out;
  for (const PaperMethod& method : kPaperMethods) add_paper_method(figure, method, count, out);
  if (out.empty()) figure.fail("must have participants");
  return out;
}

namespace {

/// A column of a tidy table: its name, and its cell for an answer; empty if unknown.
struct TidyColumn {
  study::Column column;
  std::function<std::string(const Answer&)> cell;
  bool always = false;  ///< written even if all its cells are empty
};

std::vector<TidyColumn> tidy_columns() {
  using study::Column;
  const auto bit = [](bool known, bool x) { return std::string(known ? (x ? "1" : "0") : ""); };
  const auto number = [](const std::optional<double>& x) {
    return x ? fmt::format("{}", *x) : std::string();
  };
  return {
      {Column::Participant, [](const Answer& a) { return a.participant; }, true},
      {Column::Method, [](const Answer& a) { return a.method; }, true},
      {Column::Scene, [](const Answer& a) { return a.scene; }, true},
      {Column::Trial, [](const Answer& a) { return a.trial; }},
      {Column::Question, [](const Answer& a) { return a.question; }},
      {Column::Answer,
       [=](const Answer& a) { return bit(a.answered && !a.question.empty(), a.yes); }},
      {Column::Correct,
       [=](const Answer& a) {
         return bit(a.answered && a.kind != AnswerKind::Adjusted, a.correct);
       },
       true},
      {Column::Level, [=](const Answer& a) { return number(a.level); }},
      {Column::Kind,
       [](const Answer& a) {
         return std::string(a.kind == AnswerKind::Right ? "" : name_of(a.kind));
       }},
      {Column::ResponseTime, [=](const Answer& a) { return number(a.response_s); }},
      {Column::Stimulus, [](const Answer& a) { return a.stimulus; }},
      {Column::Gate, [](const Answer& a) { return a.gate; }},
      {Column::Protocol, [](const Answer& a) { return a.run.protocol; }},
      {Column::Version, [](const Answer& a) { return a.run.version; }},
      {Column::Device, [](const Answer& a) { return a.run.device; }},
      {Column::Array, [](const Answer& a) { return a.run.array; }},
      {Column::Hand, [](const Answer& a) { return a.run.hand; }},
  };
}

std::string csv_cell(const std::string& value) {
  const auto needs_quotes = [](char c) {
    // ";" and "|", so that no other separator is taken for that of the table
    return c == ',' || c == '"' || c == ';' || c == '|' || static_cast<unsigned char>(c) < 0x20;
  };
  if (std::none_of(value.begin(), value.end(), needs_quotes)) return value;
  std::string out = "\"";
  for (const char c : value) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + '"';
}

/// Names of all other columns, in order of first appearance.
std::vector<std::string> other_names(std::span<const Answer> answers) {
  std::vector<std::string> names;
  std::set<std::string> known;
  for (const Answer& a : answers) {
    for (const auto& [name, cell] : a.other) {
      if (known.insert(name).second) names.push_back(name);
    }
  }
  return names;
}

std::string csv_line(const std::vector<std::string>& cells) {
  std::string out;
  for (const std::string& cell : cells) {
    out += &cell == &cells.front() ? "" : ",";
    out += csv_cell(cell);
  }
  return out + "\r\n";
}

}  // namespace

std::string tidy_csv(std::span<const Answer> answers) {
  std::vector<TidyColumn> columns = tidy_columns();
  std::erase_if(columns, [&](const TidyColumn& of) {
    const auto is_empty = [&](const Answer& a) { return of.cell(a).empty(); };
    return !of.always && std::all_of(answers.begin(), answers.end(), is_empty);
  });
  const std::vector<std::string> others = other_names(answers);
  std::vector<std::string> cells;
  for (const TidyColumn& of : columns) cells.emplace_back(name_of(of.column));
  cells.insert(cells.end(), others.begin(), others.end());
  std::string out = csv_line(cells);
  for (const Answer& a : answers) {
    cells.clear();
    for (const TidyColumn& of : columns) cells.push_back(of.cell(a));
    const std::map<std::string, std::string> other(a.other.begin(), a.other.end());
    for (const std::string& name : others) {
      const auto found = other.find(name);
      cells.push_back(found == other.end() ? std::string() : found->second);
    }
    out += csv_line(cells);
  }
  return out;
}

namespace {

/// Whether a file is a participant's, judging by its name.
bool is_responses(std::string_view path) {
  return path.ends_with(".jsonl");
}

/// Reads several files into one list of answers.
class Files {
 public:
  Files(const ReadingSettings& settings, Tasks tasks, std::vector<std::string>& notes)
      : settings_(settings), tasks_(tasks), notes_(notes) {}

  void read(std::span<const std::string> paths);
  std::vector<Answer> take();

 private:
  /// Whether the file's participant was replaced by another one of the roster; adds a note if so.
  bool was_replaced(const std::string& path, std::span<const RosterEntry> roster);
  void read_one(const std::string& path, const std::string& prefix);
  void refuse_copies(const std::string& path, const std::string& text);
  void add(std::vector<Answer> answers, const std::string& path);

  const ReadingSettings& settings_;
  Tasks tasks_;
  std::vector<std::string>& notes_;
  std::vector<Answer> all_;
  std::vector<study::StudyFile> studies_;
  std::map<std::size_t, std::string> file_with_;  // by hash of its content
  std::map<std::string, std::string> file_of_;    // by participant
};

void Files::read(std::span<const std::string> paths) {
  std::vector<std::string> prefixes(paths.size());
  if (settings_.prefix.value_or(IdPrefix::None) != IdPrefix::None)
    prefixes = study::distinct_parts(paths, *settings_.prefix);
  const bool by_folder = settings_.prefix == IdPrefix::Folder;
  std::map<std::string, std::vector<RosterEntry>> rosters;  // of each folder that has its numbers
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (!is_responses(paths[i])) continue;
    std::vector<std::string> faults;  // reading the answers reports them
    std::vector<RosterEntry> entry = read_roster(paths.subspan(i, 1), &faults);
    std::move(entry.begin(), entry.end(),
              std::back_inserter(rosters[by_folder ? prefixes[i] : ""]));
  }
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (was_replaced(paths[i], rosters[by_folder ? prefixes[i] : ""])) continue;
    read_one(paths[i], prefixes[i].empty() ? prefixes[i] : prefixes[i] + '/');
  }
  if (all_.empty()) throw InputError(paths.front() + ": has no answer");
}

bool Files::was_replaced(const std::string& path, std::span<const RosterEntry> roster) {
  const auto entry = std::find_if(roster.begin(), roster.end(),
                                  [&](const RosterEntry& e) { return e.file == path; });
  const RosterEntry* by = entry == roster.end() ? nullptr : replacement_of(roster, *entry);
  if (by == nullptr) return false;
  notes_.push_back(fmt::format("Participant {} was replaced by {} and is left out ({}).",
                               entry->participant, by->participant, path));
  return true;
}

void Files::refuse_copies(const std::string& path, const std::string& text) {
  const auto [found, is_new] = file_with_.emplace(std::hash<std::string>()(text), path);
  if (!is_new) {
    throw InputError(
        fmt::format("{} and {} have the same content; leave one of them out", found->second, path));
  }
}

/// Refuses a table in JSON, as written by jsPsych and pandas.
void refuse_list(std::string_view text, const std::string& path) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos || text[first] != '[') return;
  throw InputError(
      fmt::format("{0}: is a JSON list, as written by jsPsych; save the answers as CSV, or convert "
                  "them: python3 -c "
                  "'import pandas; pandas.read_json(\"{0}\").to_csv(\"{0}.csv\", index=False)'",
                  path));
}

void Files::read_one(const std::string& path, const std::string& prefix) {
  const auto is_table = [&](std::string_view ending) { return path.ends_with(ending); };
  constexpr std::array<std::string_view, 3> kTables = {".csv", ".tsv", ".txt"};
  if (is_table(".json")) refuse_list(read_file(path, kMaxBytes), path);
  if (!is_responses(path) && std::none_of(kTables.begin(), kTables.end(), is_table)) {
    throw InputError(
        path +
        ": the name must end in .jsonl, a participant's file, in .csv, .tsv or .txt, a "
        "table (save spreadsheets as CSV in UTF-8), or in .json, the paper's Fig. 4, "
        "alone");
  }
  const std::string text = read_file(path, kMaxBytes);
  refuse_copies(path, text);
  std::vector<Answer> answers;
  if (is_responses(path)) {
    study::Responses responses = study::read_responses(text, path, tasks_, notes_);
    responses.file.participant = prefix + responses.file.participant;
    if (!responses.answers.empty()) studies_.push_back(std::move(responses.file));
    answers = std::move(responses.answers);
  } else {
    answers = answers_from_csv(text, path, settings_.columns, &notes_);
  }
  for (Answer& answer : answers) answer.participant = prefix + answer.participant;
  add(std::move(answers), path);
}

void Files::add(std::vector<Answer> answers, const std::string& path) {
  for (const Answer& answer : answers) {
    const auto [found, is_new] = file_of_.emplace(answer.participant, path);
    if (is_new || found->second == path || settings_.prefix == IdPrefix::None) continue;
    throw InputError(fmt::format(
        "participant {} is in {} and in {}; if these are two people, add --prefix folder or "
        "--prefix "
        "file, which prefixes their names; if one, add --prefix none, or leave a file out",
        found->first, found->second, path));
  }
  all_.insert(all_.end(), std::make_move_iterator(answers.begin()),
              std::make_move_iterator(answers.end()));
}

/// Notes the number of trials that were presented although the gate did not pass.
void note_anyway(std::span<const Answer> answers, std::vector<std::string>& notes) {
  std::map<std::string, int> passed_over;
  for (const Answer& a : answers) {
    if (a.gate == "anyway") ++passed_over[a.method];
  }
  for (const auto& [method, count] : passed_over) {
    notes.push_back(
        fmt::format("{} trial{} with {} {} presented although the stimulus gate did not pass.",
                    count, count == 1 ? "" : "s", method, count == 1 ? "was" : "were"));
  }
}

std::vector<Answer> Files::take() {
  for (const Answer& a : all_) {
    if (a.kind == all_.front().kind) continue;
    throw InputError(
        fmt::format("participants {} and {} had different tasks; analyse each study separately",
                    all_.front().participant, a.participant));
  }
  study::require_same_stimuli(all_, studies_, settings_.pool, notes_);
  study::rename(all_, settings_.rename);
  study::settle_spellings(all_, settings_.merge_spellings, notes_);
  note_anyway(all_, notes_);
  return std::move(all_);
}

}  // namespace

std::vector<Answer> answers_from_responses(std::string_view text, const std::string& file,
                                           std::vector<std::string>& notes, Tasks tasks) {
  return study::read_responses(text, file, tasks, notes).answers;
}

std::vector<Answer> read_answers(std::span<const std::string> paths,
                                 std::vector<std::string>& notes, const ReadingSettings& settings,
                                 Tasks tasks) {
  if (paths.size() == 1 && paths.front().ends_with(".json")) {
    const std::string text = read_file(paths.front(), kMaxBytes);
    refuse_list(text, paths.front());
    return answers_from_paper(text, paths.front());
  }
  Files files(settings, tasks, notes);
  files.read(paths);
  return files.take();
}

}  // namespace prostm
