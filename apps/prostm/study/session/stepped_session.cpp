#include "study/session/stepped_session.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "common.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/device/simulated/simulated_array.hpp"
#include "prostm/study/live/stepped_rehearsal.hpp"
#include "prostm/viewer/study_view.hpp"
#include "study/session/session_place.hpp"
#include "study/session/session_report.hpp"
#include "study/study_protocol.hpp"

namespace prostm::app {
namespace {

void require_no_room(const StudyRunOptionsGiven& given) {
  if (!given.rehearse) {
    throw InputError(
        "--as-fast-as-possible has a simulated clock, which people cannot follow; add --rehearse "
        "0");
  }
  if (!given.markers.empty()) {
    throw InputError(
        "--markers sends the times of real output; leave it out, or leave out "
        "--as-fast-as-possible");
  }
  if (names_tracker(given.run.hand)) {
    throw InputError(fmt::format(
        "--hand {} is tracked in real time; leave it out, or leave out --as-fast-as-possible",
        given.run.hand));
  }
}

/// Steps until the rehearsal is done. @return whether it was.
bool rehearse(SteppedRehearsal& rehearsal, const StudySession& session, const Pipeline& pipeline,
              SessionPlans& plans, const Interrupt& interrupt) {
  Progress progress("rehearsing");
  while (!rehearsal.is_done()) {
    if (interrupt.requested()) return false;
    if (rehearsal.step()) plans.offer(pipeline.contact(), pipeline.plan());
    progress.show(static_cast<double>(session.trials_done()),
                  static_cast<double>(session.course().most()), "trials");
  }
  return true;
}

}  // namespace

int stepped_session(const StudyRunOptionsGiven& given) {
  require_no_room(given);
  PipelineSettings base = study_settings(given.run.common);
  base.devices.of<SimulatedArraySettings>().realtime = false;
  settle_hand(given.run.hand, given.run.hand_size, base);
  check_mode(base, RunMode::Stepped);
  const Protocol protocol = live_protocol(given.protocol, base);
  const SessionPlace place = session_place(given, protocol);
  PipelineSettings settings = protocol.methods.front().settings;
  settings.scene = "still-air";
  const auto mute = std::make_shared<Mute>();
  Pipeline pipeline(settings, make_hands(given.run.hand, settings), mute);
  warn_of(pipeline.world_stage().hands());

  const Interrupt interrupt;
  ResponseFile file(place.path, given.take_over ? ForeignLock::Replaced : ForeignLock::Respected);
  if (!file.lock_notice().empty()) warn(file.lock_notice());
  const StudySight now = study_time();
  StudySession session(protocol, place.participant, file, run_facts(given, settings), now,
                       place.replaces);
  SteppedRehearsal rehearsal(pipeline, mute, session, *rehearsal_of(given, place.participant), now);
  SessionPlans plans;
  const bool done = rehearse(rehearsal, session, pipeline, plans, interrupt);
  pipeline.silence();
  require_written(session, now.time + rehearsal.time());
  fmt::print("Rehearsed {:.0f} s of a session with a simulated clock.\n", rehearsal.time());
  print_session(stdout, session, file, RunSummary(), plans, settings);
  return done ? 0 : interrupt.status();
}

}  // namespace prostm::app
