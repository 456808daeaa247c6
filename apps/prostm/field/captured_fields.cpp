#include "field/captured_fields.hpp"

#include <exception>

#include "prostm/pipeline/runner.hpp"

namespace prostm::app {
namespace {

class Capture final : public RunObserver {
 public:
  Capture(Recorder& recorder, int frames, const std::function<bool(int)>& go_on, double from)
      : recorder_(recorder), frames_(frames), go_on_(go_on), from_(from) {}

  bool on_plan(const WorldFrame& contact, const PlanFrame& plan) override {
    const bool counts = plan.status == PlanStatus::Planned && contact.target.time >= from_;
    if (counts && taken_ < frames_) {
      const RecordedPlan made{plan.plan, plan.stats, plan.full_scale_pressure, plan.sigma};
      recorder_.append(contact.target, contact.hands, &made, plan.gate);
      ++taken_;
    }
    return taken_ < frames_ && go_on_(taken_);
  }
  bool on_progress(double) override { return taken_ < frames_ && go_on_(taken_); }
  int taken() const { return taken_; }

 private:
  Recorder& recorder_;
  int frames_, taken_ = 0;
  const std::function<bool(int)>& go_on_;
  double from_;
};

}  // namespace

double capture_limit(const PipelineSettings& settings, int frames) {
  return 120.0 + 10.0 * frames * settings.steps_per_plan() / settings.world_rate;
}

int capture_fields(Pipeline& pipeline, const PipelineSettings& settings, Recorder& recorder,
                   int frames, const std::function<bool(int taken)>& go_on, double from) {
  RunOptions options;
  options.mode = RunMode::AsFastAsPossible;
  options.seconds = capture_limit(settings, frames);
  Capture capture(recorder, frames, go_on, from);
  const RunSummary summary = run(pipeline, settings, options, capture);
  if (summary.failure) std::rethrow_exception(summary.failure);
  return capture.taken();
}

}  // namespace prostm::app
