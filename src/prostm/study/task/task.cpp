#include "prostm/study/task/task.hpp"

#include <fmt/format.h>

#include "prostm/study/task/line_keys.hpp"
#include "prostm/study/task/perception.hpp"

namespace prostm {

void Task::check(const Protocol&) const {}

std::vector<Trial> Task::trials(const Protocol& protocol, int participant) const {
  return trial_order(protocol, participant);
}

TrackPlan Task::tracks(const Protocol& protocol) const {
  const LevelSettings& level = protocol.level;
  return {level.tracks, level.trials, level.procedure == Staircase::UpDown};
}

Procedure Task::procedure(const Protocol& protocol, std::uint64_t) const {
  return staircase_of(protocol.level, guess(protocol));
}

int Task::draw_interval(Random& random) const {
  return 1 + random.below(traits_.intervals);
}

IntervalPlan Task::intervals(const Protocol& protocol, const Trial& trial) const {
  IntervalPlan plan;
  plan.length = traits_.has_levels ? protocol.level.interval : protocol.trials.time_limit;
  plan.gap = protocol.level.gap;
  plan.in_turn = is_tuned();
  plan.answer_after = protocol.trials.fixed_duration;
  plan.shows_level.clear();
  for (int i = 1; i <= traits_.intervals; ++i)
    plan.shows_level.push_back(!traits_.compares || i == trial.level_at);
  return plan;
}

std::variant<int, std::string> Task::answer_of(const StudyAct& act) const {
  switch (traits_.form) {
    case AnswerForm::YesNo:
      if (act.interval > 0) return "the answer is yes or no";
      return act.yes ? 1 : 0;
    case AnswerForm::Interval:
      if (act.interval >= 1 && act.interval <= traits_.intervals) return act.interval;
      return fmt::format("the answer is an interval, 1 {} {}", traits_.intervals == 2 ? "or" : "to",
                         traits_.intervals);
    case AnswerForm::Tuned:
      break;
  }
  return fmt::format("task {} has no answer: tune it and accept it", traits_.name);
}

std::vector<int> Task::answers() const {
  if (traits_.form == AnswerForm::YesNo) return {1, 0};
  std::vector<int> out;
  for (int i = 1; traits_.form == AnswerForm::Interval && i <= traits_.intervals; ++i)
    out.push_back(i);
  return out;
}

double Task::guess(const Protocol& protocol) const {
  const bool right = answer_kind(protocol.standard.has_value()) == AnswerKind::Right;
  return right ? 1.0 / static_cast<double>(answers().size()) : 0.0;
}

void Task::add_stimulus(nlohmann::ordered_json& line, const Protocol& protocol,
                        const Trial& trial) const {
  const auto name_of_scene = [&](int scene) {
    return protocol.scenes[static_cast<std::size_t>(scene)].name;
  };
  line[line::kMethod] = protocol.methods[static_cast<std::size_t>(trial.method)].name;
  line[line::kScene] = name_of_scene(trial.scene);
  if (!trial.level) {
    line[line::kQuestion] = name_of_scene(trial.question);
    return;
  }
  line[line::kTrack] = trial.track;
  line[line::kLevel] = *trial.level;
  if (!traits_.compares) return;
  if (protocol.standard) {
    line[line::kReference] = protocol.standard->name;
  } else {
    line[line::kReference] = protocol.level.reference;
  }
  if (traits_.intervals > 1 && !is_tuned()) line[line::kInterval] = trial.level_at;
}

void Task::add_answer(nlohmann::ordered_json& line, const Protocol& protocol, const Trial& trial,
                      int answer) const {
  line[line::kAnswer] = answer;
  if (traits_.has_levels) line[line::kFelt] = felt(trial, answer) ? 1 : 0;
  if (answer_kind(protocol.standard.has_value()) == AnswerKind::Right)
    line[line::kCorrect] = is_right(trial, answer) ? 1 : 0;
}

StudyAct Task::act_of(int answer) const {
  if (traits_.form == AnswerForm::Interval)
    return {.what = StudyAct::Do::Answer, .interval = answer};
  return {.what = StudyAct::Do::Answer, .yes = answer == 1};
}

StudyAct Task::respond(const Trial& trial, Perception& perception) const {
  const bool for_level = perception.feels(*trial.level);
  std::vector<int> fitting;
  for (const int answer : answers())
    if (felt(trial, answer) == for_level) fitting.push_back(answer);
  if (fitting.size() == 1) return act_of(fitting.front());
  return act_of(
      fitting[static_cast<std::size_t>(perception.guess(static_cast<int>(fitting.size())))]);
}

StudyAct Task::guessed(Random& random) const {
  const std::vector<int> all = answers();
  return act_of(all[static_cast<std::size_t>(random.below(static_cast<int>(all.size())))]);
}

}  // namespace prostm
