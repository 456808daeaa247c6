#include "study/session/session_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "prostm/acoustics/skin/sensation_level.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/study/task/line_keys.hpp"

namespace prostm::app {
namespace {

std::size_t answers_in(const std::vector<ResponseLine>& lines) {
  return static_cast<std::size_t>(std::ranges::count_if(
      lines, [](const ResponseLine& l) { return l.value(line::kKind, "") == line::kTrial; }));
}

}  // namespace

void SessionPlans::print_quality(std::FILE* out, PipelineSettings settings,
                                 const Protocol& protocol) const {
  for (const Method kind : {Method::ProStm, Method::Am}) {
    const auto method = std::ranges::find_if(protocol.methods, [&](const StudyMethod& of_study) {
      return of_study.settings.method == kind;
    });
    if (method == protocol.methods.end()) continue;
    settings.emit = method->settings.emit;
    const auto quality = plans_[static_cast<std::size_t>(kind)].quality(settings, true);
    print_run_quality(out, kind == Method::Am ? "stimuli of stationary foci" : "stimuli of paths",
                      quality, sensation_interval(settings.transducers));
  }
}

void print_session(std::FILE* out, const StudySession& session, const ResponseFile& file,
                   const RunSummary& summary, const SessionPlans& plans,
                   const PipelineSettings& settings) {
  const Course& course = session.course();
  const std::size_t answers = answers_in(file.lines());  // not those that could not be written
  if (course.is_open()) {
    const bool all = course.is_done() && session.unwritten().empty();
    fmt::print(out, "Participant {}: {} answers in {}{}.\n", session.participant(), answers,
               file.path(), all ? ", which are all" : "");
  } else {
    fmt::print(out, "Participant {}: {} of {} answers in {}.\n", session.participant(), answers,
               course.most(), file.path());
  }
  const std::string strengths = session.strengths();
  if (!strengths.empty()) {
    fmt::print(out, "{}\n", strengths);
  } else if (session.strength_difference() > 0.0) {
    fmt::print(out, "Scenes of one method differ in strength by {:.0f} % ({:.0f} % are allowed).\n",
               100.0 * session.strength_difference(), 100.0 * session.protocol().trials.strength);
  }
  if (summary.skipped_world_steps > 0 || summary.device.missed_blocks > 0) {
    fmt::print(out,
               "The machine did not keep up: {} steps of the smoke were skipped and {} blocks of "
               "the output missed; see prostm check.\n",
               summary.skipped_world_steps, summary.device.missed_blocks);
  }
  plans.print_quality(out, settings, session.protocol());
}

void require_written(StudySession& session, double time) {
  const std::string problem = session.finish(time);
  if (problem.empty()) return;
  throw InputError(fmt::format("{}; lost answers: {}; continue with --resume", problem,
                               answers_in(session.unwritten())));
}

}  // namespace prostm::app
