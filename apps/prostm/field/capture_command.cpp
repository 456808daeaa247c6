#include <fmt/format.h>

#include "common.hpp"
#include "field/captured_fields.hpp"
#include "prostm/commit.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/device/simulated/simulated_array.hpp"
#include "prostm/io/recorder.hpp"
#include "prostm/pipeline/runner.hpp"

namespace prostm::app {
namespace {

/// @throws InputError for a hand that needs real time.
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
  settings.devices.of<SimulatedArraySettings>().realtime = false;
  Pipeline pipeline(settings, make_hands(given.hand, settings));
  warn_of(pipeline.world_stage().hands());
  Recorder recorder(given.out, settings_groups(settings));
  recorder.set_attribute("prostm", version_text());
  recorder.set_attribute("scene", settings.scene);
  recorder.set_attribute("hand", given.hand);

  const Interrupt interrupt;
  Progress progress("capturing");
  const double limit = capture_limit(settings, given.frames);
  const int taken = capture_fields(pipeline, settings, recorder, given.frames, [&](int so_far) {
    progress.show(so_far, given.frames, "frames");
    return !interrupt.requested();
  });
  progress.clear();
  recorder.close();
  std::FILE* out = prose(given.common.json);
  fmt::print(out, "recorded {} fields with pressure from {}\n", taken, settings.scene);
  say_written(out, given.out);
  write_json(given.common.json,
             {{"file", given.out}, {"scene", settings.scene}, {"frames", taken}});
  say_written(out, given.common.json);
  if (interrupt.requested()) return interrupt.status();
  if (taken < given.frames) {
    throw InputError(
        fmt::format("only {} of {} fields had pressure in {:.0f} s of {}; is the hand in the box?",
                    taken, given.frames, limit, given.hand));
  }
  return 0;
}

}  // namespace prostm::app
