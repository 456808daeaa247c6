#pragma once
/// A task that prostm does not have: one of three intervals presents the level, and two the
/// standard's. Which is the odd one out?

#include "prostm/study/task/task.hpp"
#include "prostm/study/task/tasks.hpp"

namespace prostm::test {

class OddOneOut final : public Task {
 public:
  OddOneOut()
      : Task({.name = "odd-one-out",
              .form = AnswerForm::Interval,
              .words = kWords,
              .spoken = "Say one, two or three.",
              .compares = true,
              .intervals = 3}) {}

  bool felt(const Trial& trial, int answer) const override { return answer == trial.level_at; }
  AnswerKind answer_kind(bool) const override { return AnswerKind::Right; }

 private:
  static constexpr std::array<std::string_view, 3> kWords = {"The first", "The second",
                                                             "The third"};
};

/// The tasks of prostm, plus this one.
inline Tasks tasks_with_odd_one_out() {
  static const OddOneOut odd;
  static const std::vector<const Task*> tasks = [] {
    std::vector<const Task*> all(study_tasks().begin(), study_tasks().end());
    all.push_back(&odd);
    return all;
  }();
  return tasks;
}

}  // namespace prostm::test
