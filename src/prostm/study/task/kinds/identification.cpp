/// Identification: one interval; the participant says whether it was the scene in question.

#include "prostm/study/task/task.hpp"
#include "prostm/study/task/tasks.hpp"

namespace prostm {
namespace {

constexpr std::array<std::string_view, 2> kWords = {"Yes", "No"};

class IdentificationTask final : public Task {
 public:
  IdentificationTask()
      : Task({.name = "identification",
              .form = AnswerForm::YesNo,
              .words = kWords,
              .spoken = "Say yes or no.",
              .has_levels = false,
              .pictured = true,
              .least_scenes = 2}) {}

  bool felt(const Trial&, int answer) const override { return answer == 1; }
  bool is_right(const Trial& trial, int answer) const override {
    return (answer == 1) == (trial.scene == trial.question);
  }
  AnswerKind answer_kind(bool) const override { return AnswerKind::Right; }
};

}  // namespace

const Task& identification() {
  static const IdentificationTask task;
  return task;
}

}  // namespace prostm
