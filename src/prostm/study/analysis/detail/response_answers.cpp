#include "prostm/study/analysis/detail/response_answers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/crc.hpp>

#include "prostm/core/input_error.hpp"
#include "prostm/core/text/nearest_name.hpp"
#include "prostm/study/extra/extra_answers.hpp"
#include "prostm/study/session/response_file.hpp"
#include "prostm/study/task/line_keys.hpp"
#include "prostm/study/task/task.hpp"

namespace prostm::study {
namespace {

/// The kind of the answers, from the protocol in the first line of a participant's file.
AnswerKind kind_of(const ResponseLine& protocol, Tasks tasks, const std::string& file) {
  const auto trials = protocol.value("trials", ResponseLine::object());
  const auto level = protocol.value("level", ResponseLine::object());
  const std::string name = trials.value("task", tasks.front()->name());
  const auto found = std::find_if(tasks.begin(), tasks.end(),
                                  [&](const Task* task) { return task->name() == name; });
  if (found != tasks.end()) return (*found)->answer_kind(!level.value("against", "").empty());
  throw InputError(fmt::format("{}, line 1: the task {} is unknown", file, shown_name(name)));
}

/// A cell of a table: true and false are 1 and 0, null is empty.
std::string cell_of(const ResponseLine& value) {
  if (value.is_null()) return "";
  if (value.is_boolean()) return value.get<bool>() ? "1" : "0";
  return value.is_string() ? value.get<std::string>() : value.dump();
}

/// Facts in a trial's line besides the answer. Each trial of a study has the same columns.
std::vector<std::pair<std::string, std::string>> other_of(const ResponseLine& line) {
  std::vector<std::pair<std::string, std::string>> out;
  for (const char* key : {line::kTrack, line::kReference, line::kInterval, line::kStart,
                          line::kAnyway, line::kTarget, line::kRendered, line::kHandGone}) {
    if (const auto found = line.find(key); found != line.end())
      out.emplace_back(key, cell_of(*found));
  }
  if (const auto played = line.find(line::kPlayed); played != line.end()) {
    for (const char* key : {"speed_m_s", "period_ms", "changed_paths"}) {
      const bool is_known = played->is_object() && played->contains(key);
      out.emplace_back(fmt::format("played_{}", key), is_known ? cell_of(played->at(key)) : "");
    }
  }
  for (const char* key : {"utc", "time_s"}) {
    if (const auto found = line.find(key); found != line.end())
      out.emplace_back(key, cell_of(*found));
  }
  return out;
}

/// Sets the answer as it was given, where it is not the one to a question.
void set_given(const ResponseLine& line, Answer& out) {
  const auto given = line.find(line::kAnswer);
  if (given == line.end() || !out.question.empty()) return;
  constexpr const char* kGiven = "answer_given";
  const auto found = std::find_if(out.other.begin(), out.other.end(),
                                  [](const auto& of) { return of.first == kGiven; });
  if (found == out.other.end()) {
    out.other.emplace(out.other.begin(), kGiven, cell_of(*given));
  } else {
    found->second = cell_of(*given);
  }
}

Answer answer_of(const ResponseLine& line, const std::string& participant, AnswerKind kind) {
  Answer answer;
  answer.participant = participant;
  answer.method = line.at(line::kMethod);
  answer.scene = line.at(line::kScene);
  answer.trial = std::to_string(line.at(line::kTrial).get<int>());
  if (line.contains(line::kLevel)) {
    answer.level = line.at(line::kLevel).get<double>();
  } else {
    answer.question = line.at(line::kQuestion);
  }
  answer.kind = kind;
  if (line.contains(line::kResponseTime))
    answer.response_s = line[line::kResponseTime].get<double>();
  answer.stimulus = line.value(line::kStimulus, "");
  if (const auto gate = line.find(line::kGate); gate != line.end() && gate->is_object())
    answer.gate = gate->value("pass", false) ? "pass" : "fail";
  if (line.value(line::kAnyway, false)) answer.gate = "anyway";
  answer.other = other_of(line);
  return answer;
}

std::string text_in(const ResponseLine& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
}

/// The run, from the first line of a participant's file.
RunFacts facts_of(const ResponseLine& first) {
  boost::crc_32_type sum;
  const auto protocol = first.find(line::kProtocol);
  const std::string text = protocol == first.end() ? std::string() : protocol->dump();
  sum.process_bytes(text.data(), text.size());
  const ResponseLine& run = first.at(line::kRun);
  return {text.empty() ? std::string() : fmt::format("{:08x}", sum.checksum()),
          text_in(run, "prostm"), text_in(run, "device"), text_in(run, "array"),
          text_in(run, "hand")};
}

/// Adds the trial of a line, or corrects the last trial.
void take_line(const ResponseLine& line, const std::string& where, AnswerKind of, Responses& out) {
  const std::string kind = line.value(line::kKind, "");
  if (kind == line::kTrial) {
    out.answers.push_back(answer_of(line, out.file.participant, of));
  } else if (out.answers.empty() ||
             out.answers.back().trial != std::to_string(line.at(line::kTrial).get<int>())) {
    throw InputError(where + " corrects a trial that is not the last");
  }
  if (of == AnswerKind::Adjusted) return;
  Answer& answer = out.answers.back();
  set_given(line, answer);
  answer.correct = line.at(of == AnswerKind::Felt ? line::kFelt : line::kCorrect).get<int>() == 1;
  if (!answer.question.empty()) answer.yes = line.at(line::kAnswer).get<int>() == 1;
}

}  // namespace

Responses read_responses(std::string_view text, const std::string& file, Tasks tasks,
                         std::vector<std::string>& notes) {
  Responses out;
  const std::vector<ResponseLine> lines = responses_from_text(text, file);
  std::string where = file + ", line 1";
  try {
    if (lines.empty() || lines.front().value(line::kFormat, "") != kResponseFormat)
      throw InputError(where +
                       " is not the first line of a participant's file of prostm study run");
    const ResponseLine& first = lines.front();
    out.file = {first.at(line::kParticipant), first.value(line::kProtocol, ResponseLine::object()),
                first.at(line::kRun).at("rehearsal")};
    out.trials = first.at(line::kTrials);
    const AnswerKind of = kind_of(out.file.protocol, tasks, file);
    const RunFacts facts = facts_of(first);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const std::string kind = lines[i].value(line::kKind, "");
      where = fmt::format("{}, line {}", file, i + 1);
      if (kind == line::kEnd) {
        out.ended = true;
        const std::string strengths = text_in(lines[i], line::kStrengths);
        if (!strengths.empty()) notes.push_back(file + ": " + strengths);
      }
      if (kind == line::kTrial || kind == line::kCorrection) take_line(lines[i], where, of, out);
    }
    for (Answer& answer : out.answers) answer.run = facts;
    const auto extra = sentences(extra_answers(lines), out.file.participant);
    notes.insert(notes.end(), extra.begin(), extra.end());
  } catch (const ResponseLine::exception& error) {
    throw InputError(fmt::format("{}: {}", where, error.what()));
  }
  if (out.file.rehearsal)
    notes.push_back(file + " is a rehearsal: nobody felt anything, and the answers are simulated.");
  if (!out.ended && static_cast<int>(out.answers.size()) < out.trials) {
    notes.push_back(fmt::format("Participant {} gave {} of {} answers ({}).", out.file.participant,
                                out.answers.size(), out.trials, file));
  }
  return out;
}

}  // namespace prostm::study
