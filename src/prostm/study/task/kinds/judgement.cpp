/// Judgement: one interval at a level, and a question with the answer yes or no.

#include "prostm/study/task/task.hpp"
#include "prostm/study/task/tasks.hpp"

namespace prostm {
namespace {

constexpr std::array<std::string_view, 2> kWords = {"Yes", "No"};

class JudgementTask final : public Task {
 public:
  JudgementTask()
      : Task({.name = "judgement",
              .form = AnswerForm::YesNo,
              .words = kWords,
              .spoken = "Say yes or no."}) {}

  bool felt(const Trial&, int answer) const override { return answer == 1; }
  AnswerKind answer_kind(bool) const override { return AnswerKind::Felt; }
};

}  // namespace

const Task& judgement() {
  static const JudgementTask task;
  return task;
}

}  // namespace prostm
