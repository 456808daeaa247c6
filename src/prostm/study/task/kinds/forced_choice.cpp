/// Forced choice: two intervals, one with the level and one with the standard; the participant
/// chooses one.

#include <fmt/format.h>

#include <stdexcept>

#include "prostm/study/task/task.hpp"
#include "prostm/study/task/tasks.hpp"

namespace prostm {
namespace {

constexpr std::array<std::string_view, 2> kWords = {"The first", "The second"};

class ForcedChoiceTask final : public Task {
 public:
  ForcedChoiceTask()
      : Task({.name = "forced-choice",
              .form = AnswerForm::Interval,
              .words = kWords,
              .spoken = "Say one or two.",
              .compares = true,
              .intervals = 2}) {}

  void check(const Protocol& protocol) const override {
    const LevelSettings& level = protocol.level;
    if (protocol.standard || level.reference <= level.low) return;
    throw std::invalid_argument(
        fmt::format("level.reference = {:g} must not be above low, {:g}: the right answer is "
                    "the interval of the higher level",
                    level.reference, level.low));
  }
  bool felt(const Trial& trial, int answer) const override { return answer == trial.level_at; }
  AnswerKind answer_kind(bool other_standard) const override {
    return other_standard ? AnswerKind::Felt : AnswerKind::Right;
  }
};

}  // namespace

const Task& forced_choice() {
  static const ForcedChoiceTask task;
  return task;
}

}  // namespace prostm
