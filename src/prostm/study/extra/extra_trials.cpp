#include "prostm/study/extra/extra_trials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "prostm/study/task/task.hpp"

namespace prostm {
namespace {

bool has_right_answers(const Protocol& protocol) {
  return protocol.trials.task->answer_kind(protocol.standard.has_value()) == AnswerKind::Right;
}

}  // namespace

Random ExtraTrials::random_of(ExtraKind kind, std::size_t index) const {
  Random seeds =
      random_for(protocol_, Purpose::ExtraTrials, static_cast<std::uint32_t>(participant_));
  constexpr std::uint64_t kSpread = 0x9e3779b97f4a7c15;  // 2^64 over the golden ratio
  const std::uint64_t place = kNames<ExtraKind>.size() * index + static_cast<std::uint64_t>(kind);
  return Random(seeds.bits() ^ (kSpread * (place + 1)));
}

/// Whether a check comes before this trial: once in every `every` trials, at a random place, and
/// never before the first.
bool ExtraTrials::is_due(ExtraKind kind, int every, std::size_t done) const {
  if (every == 0 || given_[static_cast<std::size_t>(kind)] == done + 1) return false;
  const std::size_t stretch = done / static_cast<std::size_t>(every);
  Random random = random_of(kind, stretch);
  const int place = stretch == 0 ? 1 + random.below(every - 1) : random.below(every);
  return done % static_cast<std::size_t>(every) == static_cast<std::size_t>(place);
}

/// A trial with the method of the next one, and a random scene and question; at a level that is
/// easy: the highest, or in practice without right answers either end of the range.
Trial ExtraTrials::drawn(Random& random, const Trial& next) const {
  const Task& task = *protocol_.trials.task;
  const int scenes = static_cast<int>(protocol_.scenes.size());
  Trial trial = {.method = next.method, .scene = random.below(scenes)};
  trial.question = task.traits().has_levels ? trial.scene : random.below(scenes);
  if (!task.traits().has_levels) return trial;
  const bool low = !has_right_answers(protocol_) && random.below(2) == 0;
  trial.level = low ? protocol_.level.low : protocol_.level.high;
  trial.level_at = task.draw_interval(random);
  return trial;
}

std::optional<ExtraTrial> ExtraTrials::next(std::size_t done, const Trial& next) const {
  if (practises()) {
    const auto index = static_cast<std::size_t>(practice_.trials());
    constexpr std::size_t kMostPractice = 1000;  // trials that draw from streams of their own
    Random random = random_of(ExtraKind::Practice, kMostPractice * done + index);
    return ExtraTrial{ExtraKind::Practice, drawn(random, next)};
  }
  const std::vector<int> answers = protocol_.trials.task->answers();
  for (const auto& [kind, every] : {std::pair{ExtraKind::Catch, protocol_.trials.catch_every},
                                    {ExtraKind::Attention, protocol_.trials.attention_every}}) {
    if (!is_due(kind, every, done)) continue;
    Random random = random_of(kind, done);
    ExtraTrial extra{kind, drawn(random, next)};
    extra.wanted =
        kind == ExtraKind::Catch
            ? 0
            : answers[static_cast<std::size_t>(random.below(static_cast<int>(answers.size())))];
    return extra;
  }
  return std::nullopt;
}

void ExtraTrials::answer(ExtraKind kind, std::size_t done, bool right) {
  if (kind == ExtraKind::Practice) {
    practice_.answer(right);
  } else {
    given_[static_cast<std::size_t>(kind)] = done + 1;
  }
}

std::optional<bool> ExtraTrials::right_answer(const ExtraTrial& extra, int answer) const {
  if (extra.wanted) return answer == *extra.wanted;
  if (!has_right_answers(protocol_)) return std::nullopt;
  return protocol_.trials.task->is_right(extra.trial, answer);
}

std::string ExtraTrials::instruction(const ExtraTrial& extra) const {
  const Task& task = *protocol_.trials.task;
  const std::vector<int> answers = task.answers();
  const auto place = std::find(answers.begin(), answers.end(), *extra.wanted) - answers.begin();
  return fmt::format("This trial checks attention. Please answer: {}.",
                     task.traits().words[static_cast<std::size_t>(place)]);
}

void validate_extra_trials(const Protocol& protocol) {
  const Task& task = *protocol.trials.task;
  const TrialSettings& trials = protocol.trials;
  const PracticeSettings& practice = protocol.practice;
  const auto require = [&](bool holds, const std::string& sentence) {
    if (!holds) throw std::invalid_argument(sentence);
  };
  const bool has_answers = task.traits().form != AnswerForm::Tuned;
  require(has_answers || (practice.trials == 0 && trials.attention_every == 0 &&
                          trials.catch_every == 0 && !trials.fixed_duration),
          fmt::format("task {} has no answers, so practice.trials, trials.catch_every, "
                      "trials.attention_every and trials.fixed_duration do not apply to it",
                      task.name()));
  require(trials.catch_every == 0 || task.traits().form == AnswerForm::YesNo,
          fmt::format("trials.catch_every needs a task with the answer no, and {} has none; use "
                      "trials.attention_every",
                      task.name()));
  require(trials.catch_every != 1, "trials.catch_every is 1; give at least 2, or 0 for none");
  require(trials.attention_every != 1,
          "trials.attention_every is 1; give at least 2, or 0 for none");
  require(!trials.fixed_duration || task.traits().has_levels || trials.time_limit > 0.0,
          "trials.fixed_duration needs the duration of the stimulus: set trials.time_limit above "
          "0 s");
  if (practice.trials == 0) return;
  require(practice.right == 0.0 || has_right_answers(protocol),
          fmt::format("practice.right needs right answers, and task {} has none with these "
                      "settings; set practice.right = 0 for a practice without a criterion",
                      task.name()));
  require(practice.right == 0.0 || practice.window <= practice.trials,
          fmt::format("practice.window = {} must not be above practice.trials = {}",
                      practice.window, practice.trials));
}

}  // namespace prostm
