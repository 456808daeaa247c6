#include <fmt/format.h>

#include "common.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/io/recorder.hpp"
#include "prostm/pipeline/runner.hpp"

namespace prostm::app {
namespace {

/// Records updates that have pressure until there are enough.
class Capture final : public RunObserver {
 public:
  Capture(Recorder& recorder, int frames) : recorder_(recorder), frames_(frames) {}

  bool on_plan(const WorldFrame& contact, const PlanFrame& plan) override {
    if (plan.status == PlanStatus::Planned && taken_ < frames_) {
      const RecordedPlan made{plan.plan, plan.stats, plan.full_scale_pressure, plan.sigma};
      recorder_.append(contact.target, contact.hands, &made, plan.gate);
      ++taken_;
    }
    return taken_ < frames_ && !interrupt_.requested();
  }
  bool on_progress(double) override {
    progress_.show(taken_, frames_, "frames");
    return taken_ < frames_ && !interrupt_.requested();
  }
  int taken() const { return taken_; }
  /// Nothing more comes.
  void end() { progress_.clear(); }
  const Interrupt& interrupt() const { return interrupt_; }

 private:
  Recorder& recorder_;
  int frames_, taken_ = 0;
  Interrupt interrupt_;
  Progress progress_{"capturing"};
};

/// @throws InputError for a hand that needs a clock.
void check_hand(const CaptureOptionsGiven& given) {
  if (given.hand != "page" && !names_tracker(given.hand)) return;
  throw InputError(fmt::format(
      "capture does not run in real time, as --hand {0} needs; record it with prostm run {1}--hand "
      "{0} --record {2}",
      given.hand, given.hand == "page" ? "--view " : "", given.out));
}

}  // namespace

int capture_command(const CaptureOptionsGiven& given) {
  if (given.frames < 1 || given.frames > 1'000'000) {
    throw InputError(fmt::format("--frames {} must be between 1 and 1000000", given.frames));
  }
  check_hand(given);
  PipelineSettings settings = make_settings(given.common, given.scene);
  settle_hand(given.hand, given.hand_size, settings);
  settings.simulated_array.realtime = false;
  Pipeline pipeline(settings, make_hands(given.hand, settings));
  Recorder recorder(given.out, settings_groups(settings));
  recorder.set_attribute("scene", settings.scene);
  recorder.set_attribute("hand", given.hand);

  // a hand is away for part of its time; one that never meets the smoke must not capture without
  // end
  RunOptions options;
  options.mode = RunMode::AsFastAsPossible;
  options.seconds = 120.0 + 10.0 * given.frames * settings.steps_per_plan() / settings.world_rate;
  Capture capture(recorder, given.frames);
  const RunSummary summary = run(pipeline, settings, options, capture);
  capture.end();
  if (summary.failure) std::rethrow_exception(summary.failure);
  recorder.close();
  std::FILE* out = prose(given.common.json);
  fmt::print(out, "{} fields of {} had pressure\n", capture.taken(), settings.scene);
  say_written(out, given.out);
  write_json(given.common.json,
             {{"file", given.out}, {"scene", settings.scene}, {"frames", capture.taken()}});
  say_written(out, given.common.json);
  if (capture.interrupt().requested()) return capture.interrupt().status();
  if (capture.taken() < given.frames) {
    throw InputError(
        fmt::format("only {} of {} fields had pressure in {:.0f} s of {}; is the hand in the box?",
                    capture.taken(), given.frames, options.seconds, given.hand));
  }
  return 0;
}

}  // namespace prostm::app
