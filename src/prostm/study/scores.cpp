#include "prostm/study/scores.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "prostm/core/file.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/json.hpp"
#include "prostm/core/nearest_name.hpp"
#include "prostm/study/detail/csv.hpp"
#include "prostm/study/response_file.hpp"
#include "prostm/study/roster.hpp"

namespace prostm {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{64} << 20;

/// The columns of a table of answers, by name.
class AnswerTable {
 public:
  AnswerTable(study::CsvReader& csv, std::vector<std::string> header)
      : csv_(csv), header_(std::move(header)) {
    for (auto it = header_.begin(); it != header_.end(); ++it) {
      if (!it->empty() && std::find(header_.begin(), it, *it) != it)
        csv_.fail("the column \"" + shown_name(*it) + "\" stands there twice");
    }
    participant_ = needed("participant");
    method_ = needed("method");
    scene_ = needed("scene");
    correct_ = needed("correct");
    question_ = find("question");
    yes_ = find("answer");
    trial_ = find("trial");
    level_ = find("level");
    kind_ = find("kind");
    if (question_.has_value() != yes_.has_value()) {
      csv_.fail(std::string("the column \"") + (question_ ? "answer" : "question") +
                "\" is missing: question and answer belong together");
    }
  }

  Answer read(const std::vector<std::string>& row) {
    if (row.size() != header_.size()) {
      csv_.fail("has " + std::to_string(row.size()) + " columns instead of the header's " +
                std::to_string(header_.size()));
    }
    Answer out;
    out.participant = name(row, participant_);
    out.method = name(row, method_);
    out.scene = name(row, scene_);
    out.correct = yes_or_no(row, correct_);
    if (question_) {
      out.question = name(row, *question_);
      out.yes = yes_or_no(row, *yes_);
      if (out.correct != ((out.question == out.scene) == out.yes)) {
        csv_.fail(std::string("correct is ") + (out.correct ? "1" : "0") + ", but the answer " +
                  (out.yes ? "1" : "0") + " to the question \"" + shown_name(out.question) +
                  "\" is " + (out.correct ? "wrong" : "right") + " where the scene is \"" +
                  shown_name(out.scene) + '"');
      }
    }
    if (trial_) {
      out.trial = name(row, *trial_);
      if (!trials_.insert({out.participant, out.trial}).second) {
        csv_.fail("participant \"" + shown_name(out.participant) + "\" has trial " +
                  shown_name(out.trial) + " a second time");
      }
    }
    if (level_) out.level = number(row, *level_);
    if (kind_) out.kind = kind(row, *kind_);
    return out;
  }

 private:
  std::optional<std::size_t> find(const char* name) const {
    const auto at = std::find(header_.begin(), header_.end(), name);
    if (at == header_.end()) return std::nullopt;
    return static_cast<std::size_t>(at - header_.begin());
  }

  std::size_t needed(const char* name) const {
    if (const auto at = find(name)) return *at;
    const bool semicolons = header_.size() == 1 && header_[0].find(';') != std::string::npos;
    csv_.fail(semicolons ? std::string("columns must be separated by commas, not semicolons")
                         : std::string("the header has no column \"") + name +
                               "\": participant, method, scene and correct are needed");
  }

  std::string name(const std::vector<std::string>& row, std::size_t column) const {
    const std::string& value = row[column];
    if (value.empty()) csv_.fail(header_[column] + " is empty");
    const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20; };
    if (std::any_of(value.begin(), value.end(), is_control))
      csv_.fail(header_[column] + " has a line break or another control character");
    return value;
  }

  bool yes_or_no(const std::vector<std::string>& row, std::size_t column) const {
    if (row[column] != "0" && row[column] != "1") {
      csv_.fail(header_[column] + " is \"" + shown_name(row[column]) + "\": it must be 0 or 1");
    }
    return row[column] == "1";
  }

  double number(const std::vector<std::string>& row, std::size_t column) const {
    const std::string& text = row[column];
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_number =
        error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
    constexpr double kLeast = 1e-9, kMost = 1e9;  // so that what is fitted stays finite
    if (!is_number || !(value == 0.0 || (std::abs(value) >= kLeast && std::abs(value) <= kMost))) {
      csv_.fail(header_[column] + " is \"" + shown_name(text) +
                "\": it must be a number in every row, 0 or from 1e-9 to 1e9 in size");
    }
    return value + 0.0;  // −0 becomes 0
  }

  AnswerKind kind(const std::vector<std::string>& row, std::size_t column) {
    const auto value = value_named<AnswerKind>(row[column]);
    if (!value) csv_.fail("kind " + must_be(row[column], kNames<AnswerKind>));
    if (*value != AnswerKind::Right && !level_)
      csv_.fail("kind is \"" + row[column] + "\", and the header has no column \"level\"");
    if (all_of_.value_or(*value) != *value)
      csv_.fail("kind is \"" + row[column] + "\", and another one in the rows before");
    all_of_ = value;
    return *value;
  }

  study::CsvReader& csv_;
  std::vector<std::string> header_;
  std::optional<AnswerKind> all_of_;
  std::size_t participant_, method_, scene_, correct_;
  std::optional<std::size_t> question_, yes_, trial_, level_, kind_;
  std::set<std::pair<std::string, std::string>> trials_;
};

/// One method of the paper's study.
struct PaperMethod {
  const char* key;
  const char* method;
};
constexpr std::array kPaperMethods = {PaperMethod{"AM", "am"}, PaperMethod{"STM", "pro-stm"}};
/// One of its scenes.
struct PaperScene {
  const char* key;
  const char* scene;
};
constexpr std::array kPaperScenes = {PaperScene{"_1plume", "one-plume"},
                                     PaperScene{"_4plume", "four-plumes"}};

/// Adds the answers of all participants who had one method.
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

std::vector<Answer> answers_from_csv(std::string_view text, const std::string& file) {
  study::CsvReader csv(text, file);
  std::vector<std::string> row;
  if (!csv.next(row)) throw InputError(file + ": has no header");
  AnswerTable table(csv, row);
  std::vector<Answer> out;
  while (csv.next(row)) out.push_back(table.read(row));
  if (out.empty()) throw InputError(file + ": has a header and no answer");
  return out;
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

std::string tidy_csv(std::span<const Answer> answers) {
  const auto quoted = [](const std::string& value) {
    if (value.find_first_of(",\"") == value.npos) return value;
    std::string out = "\"";
    for (const char c : value) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + '"';
  };
  using Column = std::pair<const char*, std::function<std::string(const Answer&)>>;
  const auto bit = [](bool x) { return std::string(x ? "1" : "0"); };
  const Answer& first = answers.front();
  std::vector<Column> columns = {
      {"participant", [](const Answer& a) { return a.participant; }},
      {"method", [](const Answer& a) { return a.method; }},
      {"scene", [](const Answer& a) { return a.scene; }},
  };
  if (!first.trial.empty()) columns.emplace_back("trial", [](const Answer& a) { return a.trial; });
  if (!first.question.empty()) {
    columns.emplace_back("question", [](const Answer& a) { return a.question; });
    columns.emplace_back("answer", [&](const Answer& a) { return bit(a.yes); });
  }
  columns.emplace_back("correct", [&](const Answer& a) { return bit(a.correct); });
  if (first.level)
    columns.emplace_back("level", [](const Answer& a) { return fmt::format("{}", *a.level); });
  if (first.kind != AnswerKind::Right)
    columns.emplace_back("kind", [](const Answer& a) { return std::string(name_of(a.kind)); });

  std::string out;
  const auto add_row = [&](const auto& value_of) {
    for (const Column& column : columns) {
      out += &column == &columns.front() ? "" : ",";
      out += quoted(value_of(column));
    }
    out += "\r\n";
  };
  add_row([](const Column& column) { return std::string(column.first); });
  for (const Answer& a : answers) add_row([&](const Column& column) { return column.second(a); });
  return out;
}

namespace {

/// The kind of the answers to a protocol, as the first line of a participant's file has it.
AnswerKind kind_of(const ResponseLine& protocol) {
  const auto trials = protocol.value("trials", ResponseLine::object());
  const auto level = protocol.value("level", ResponseLine::object());
  const std::string task = trials.value("task", "identification");
  if (task == "adjustment") return AnswerKind::Adjusted;
  const bool is_felt = task == "judgement" || !level.value("against", "").empty();
  return is_felt ? AnswerKind::Felt : AnswerKind::Right;
}

Answer answer_of(const ResponseLine& line, const std::string& participant, AnswerKind kind) {
  Answer answer;
  answer.participant = participant;
  answer.method = line.at("method");
  answer.scene = line.at("scene");
  answer.trial = std::to_string(line.at("trial").get<int>());
  if (line.contains("level")) {
    answer.level = line.at("level").get<double>();
  } else {
    answer.question = line.at("question");
  }
  answer.kind = kind;
  return answer;
}

}  // namespace

std::vector<Answer> answers_from_responses(std::string_view text, const std::string& file,
                                           std::vector<std::string>& notes) {
  std::vector<Answer> answers;
  const std::vector<ResponseLine> lines = responses_from_text(text, file);
  std::string where = file + ", line 1";
  try {
    if (lines.empty() || lines.front().value("format", "") != kResponseFormat)
      throw InputError(where + " does not begin a participant's file of prostm study run");
    const std::string participant = lines.front().at("participant");
    const int trials = lines.front().at("trials");
    const auto protocol = lines.front().value("protocol", ResponseLine::object());
    const AnswerKind of = kind_of(protocol);
    bool ended = false;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const ResponseLine& line = lines[i];
      const std::string kind = line.value("kind", "");
      ended = ended || kind == "end";
      if (kind != "trial" && kind != "correction") continue;
      where = fmt::format("{}, line {}", file, i + 1);
      if (kind == "trial") {
        answers.push_back(answer_of(line, participant, of));
      } else if (answers.empty() ||
                 answers.back().trial != std::to_string(line.at("trial").get<int>())) {
        throw InputError(where + " corrects another trial than the last");
      }
      if (of == AnswerKind::Adjusted) continue;
      const char* counts = of == AnswerKind::Felt ? "felt" : "correct";
      answers.back().correct = line.at(counts).get<int>() == 1;
      if (!answers.back().question.empty()) answers.back().yes = line.at("answer").get<int>() == 1;
    }
    if (lines.front().at("run").at("rehearsal"))
      notes.push_back(file + " is a rehearsal: nobody felt anything, and answers are made up.");
    if (!ended && static_cast<int>(answers.size()) < trials) {
      notes.push_back(fmt::format("Participant {} gave {} of {} answers ({}).", participant,
                                  answers.size(), trials, file));
    }
  } catch (const ResponseLine::exception& error) {
    throw InputError(fmt::format("{}: {}", where, error.what()));
  }
  return answers;
}

namespace {

/// Leaves out who was replaced by another participant of these files.
void leave_out_replaced(std::span<const std::string> paths, std::vector<Answer>& answers,
                        std::vector<std::string>& notes) {
  const std::vector<RosterEntry> roster = read_roster(paths);
  for (const RosterEntry& entry : roster) {
    const RosterEntry* by = replacement_of(roster, entry);
    if (by == nullptr) continue;
    std::erase_if(answers, [&](const Answer& a) { return a.participant == entry.participant; });
    notes.push_back(fmt::format("Participant {} was replaced by {} and is left out ({}).",
                                entry.participant, by->participant, entry.file));
  }
}

}  // namespace

std::vector<Answer> read_answers(std::span<const std::string> paths,
                                 std::vector<std::string>& notes) {
  const auto is_responses = [](const std::string& path) { return path.ends_with(".jsonl"); };
  if (paths.size() == 1 && !is_responses(paths.front())) {
    const std::string& path = paths.front();
    if (path.ends_with(".csv")) return answers_from_csv(read_file(path, kMaxBytes), path);
    if (path.ends_with(".json")) return answers_from_paper(read_file(path, kMaxBytes), path);
    throw InputError(
        path +
        ": the name must end in .csv, answers, .jsonl, a participant's file, or .json, "
        "the paper's Fig. 4");
  }
  std::vector<Answer> all;
  std::map<std::string, std::string> file_of;
  for (const std::string& path : paths) {
    if (!is_responses(path)) {
      throw InputError(path +
                       " stands beside other files; several at once are participants' files, whose "
                       "names end in .jsonl");
    }
    const auto answers = answers_from_responses(read_file(path, kMaxBytes), path, notes);
    if (answers.empty()) continue;
    const auto [found, is_new] = file_of.emplace(answers.front().participant, path);
    if (!is_new) {
      throw InputError(fmt::format("participant {} is in {} and in {}; leave one of them out",
                                   found->first, found->second, path));
    }
    all.insert(all.end(), answers.begin(), answers.end());
  }
  leave_out_replaced(paths, all, notes);
  if (all.empty()) throw InputError(paths.front() + ": has no answer");
  for (const Answer& a : all) {
    if (a.kind == all.front().kind) continue;
    throw InputError(
        fmt::format("participants {} and {} had other tasks; analyse those of each study alone",
                    all.front().participant, a.participant));
  }
  return all;
}

}  // namespace prostm
