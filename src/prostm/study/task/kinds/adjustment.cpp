/// Adjustment: the level is tuned until it feels like the standard; the two alternate.

#include <cmath>

#include "prostm/study/task/perception.hpp"
#include "prostm/study/task/task.hpp"
#include "prostm/study/task/tasks.hpp"

namespace prostm {
namespace {

constexpr double kContent = 0.015;  // distance at which a rehearsal accepts, over the range
constexpr double kFar = 0.15;       // distance above which it takes large steps, over the range

class AdjustmentTask final : public Task {
 public:
  AdjustmentTask()
      : Task({.name = "adjustment",
              .form = AnswerForm::Tuned,
              .spoken = "Say more or less, and when they are alike.",
              .compares = true,
              .intervals = 2,
              .answers_at_bound = 1}) {}  // each adjustment is a result

  TrackPlan tracks(const Protocol& protocol) const override {
    return {.trials = protocol.trials.repeats};
  }
  Procedure procedure(const Protocol& protocol, std::uint64_t seed) const override {
    return adjustments_of(protocol.level, protocol.trials.repeats, seed);
  }
  int draw_interval(Random&) const override { return 2; }
  bool felt(const Trial&, int) const override { return true; }
  AnswerKind answer_kind(bool) const override { return AnswerKind::Adjusted; }
  StudyAct respond(const Trial& trial, Perception& perception) const override {
    const double off = perception.distance(*trial.level);
    if (std::abs(off) < kContent) return {.what = StudyAct::Do::Accept};
    return {
        .what = StudyAct::Do::Tune, .steps = off > 0.0 ? -1 : 1, .coarse = std::abs(off) > kFar};
  }
};

}  // namespace

const Task& adjustment() {
  static const AdjustmentTask task;
  return task;
}

}  // namespace prostm
