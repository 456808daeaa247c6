#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "common.hpp"
#include "prostm/core/distribution.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/pipeline/runner.hpp"
#include "prostm/study/session/session.hpp"
#include "prostm/study/task/line_keys.hpp"
#include "run/view.hpp"
#include "study/session/session_place.hpp"
#include "study/session/session_report.hpp"
#include "study/session/stepped_session.hpp"
#include "study/study_protocol.hpp"

namespace prostm::app {
namespace {

constexpr double kADay = 86400.0;  // [s]

/// Prints new messages: markers that do not arrive, or what the session waits for.
template <class Source>
void tell_news(Source& source) {
  std::string sentence;
  while (source.next_news(sentence)) {
    fmt::print("{}\n", sentence);
    std::fflush(stdout);
  }
}

/// Ends the run when the session is closed, on a signal, or if the pages' server fails. Collects
/// the plans of its stimuli.
class Observer final : public RunObserver {
 public:
  Observer(const View& view, StudyView& study, MarkerSender& markers, const Interrupt& interrupt)
      : view_(view), study_(study), markers_(markers), interrupt_(interrupt) {}
  bool on_plan(const WorldFrame& contact, const PlanFrame& plan) override {
    plans_.offer(contact, plan);
    return goes_on();
  }
  bool on_progress(double) override {
    view_.check();
    tell_news(markers_);
    tell_news(study_);
    return goes_on();
  }
  const SessionPlans& plans() const { return plans_; }

 private:
  bool goes_on() const { return !interrupt_.requested() && !study_.closed(); }

  const View& view_;
  StudyView& study_;
  MarkerSender& markers_;
  const Interrupt& interrupt_;
  SessionPlans plans_;
};

/// Closes the pages before the data they show is destroyed, however a run ends.
class PagesEnd {
 public:
  explicit PagesEnd(View& view) : view_(view) {}
  ~PagesEnd() { view_.stop(); }

 private:
  View& view_;
};

/// Starts the pages. If that fails, the participant has not begun. @param begun the file that was
/// just created, if any.
StudyView& serve(const StudyRunOptionsGiven& given, Pipeline& pipeline, StudySession& session,
                 MarkerSender& markers, View& view, const std::string& begun) {
  try {
    return view.serve(pipeline, session, rehearsal_of(given, session.participant()), markers,
                      stdout);
  } catch (...) {
    if (!begun.empty()) std::filesystem::remove(begun);
    throw;
  }
}

/// Writes the markers that the study's thread did not write before it ended.
void write_rest(MarkerSender& markers, StudySession& session) {
  markers.stop();
  tell_news(markers);
  Marker marker;
  while (markers.next(marker)) session.note(markers.line(marker), study_time());
}

/// Returns the number of runs in a participant's file: 1, plus one for each time it was resumed.
int run_of(const ResponseFile& file) {
  const auto& lines = file.lines();
  return 1 + static_cast<int>(std::count_if(lines.begin(), lines.end(), [](const ResponseLine& l) {
           return l.value(line::kKind, "") == line::kResume;
         }));
}

/// Prints how long after their samples the markers of a run were sent.
void tell_delays(std::FILE* out, const ResponseFile& file, int run) {
  Distribution begins, ends;
  for (const ResponseLine& line : file.lines()) {
    if (line.value(line::kKind, "") != line::kMarker || line["run"] != run ||
        line["late_ms"].is_null())
      continue;
    const bool on = line["event"].get<std::string>().ends_with("-on");
    (on ? begins : ends).add(line["late_ms"].get<double>());
  }
  const auto words = [](const Distribution& delays) {
    const Summary s = delays.summary();
    return fmt::format("{:.2f} ms (99 %: {:.2f}, most {:.2f})", s.p50, s.p99, s.max);
  };
  fmt::print(out, "Markers were sent {} after {} beginnings, {} after {} ends.\n", words(begins),
             begins.count(), words(ends), ends.count());
}

}  // namespace

int study_run_command(const StudyRunOptionsGiven& given) {
  if (given.run.hand == "page")
    throw InputError(
        "--hand page needs the page of a run; the pages of a study cannot move a hand");
  if (given.as_fast_as_possible) return stepped_session(given);
  PipelineSettings base = study_settings(given.run.common);
  settle_hand(given.run.hand, given.run.hand_size, base);
  check_mode(base, RunMode::RealTime);
  const Protocol protocol = live_protocol(given.protocol, base);
  const SessionPlace place = session_place(given, protocol);
  std::vector<OpenTarget> targets = open_marker_targets(given.markers);
  PipelineSettings settings = protocol.methods.front().settings;
  settings.scene = "still-air";
  auto hands = make_hands(given.run.hand, settings);
  View view(given.run, settings);
  settings = view.settings();
  hands = view.behind_the_page(std::move(hands));
  obey_lock_memory(given.run.lock_memory, stdout);
  Pipeline pipeline(settings, std::move(hands), view.link().mute);
  warn_of(pipeline.world_stage().hands());

  const Interrupt interrupt;  // from here on a Ctrl-C ends in a report
  ResponseFile file(place.path, given.take_over ? ForeignLock::Replaced : ForeignLock::Respected);
  if (!file.lock_notice().empty()) warn(file.lock_notice());
  const bool begins = file.lines().empty();
  StudySession session(protocol, place.participant, file, run_facts(given, settings), study_time(),
                       place.replaces);
  MarkerSender markers(std::move(targets), protocol, {place.participant, run_of(file)},
                       pipeline.device(), pipeline.sound());
  const PagesEnd pages_end(view);
  StudyView& study = serve(given, pipeline, session, markers, view, begins ? place.path : "");
  if (file.found_cut_off())
    fmt::print("The last line of {0} was cut off; it is in {0}.cut-off.\n", place.path);
  if (!names_tracker(given.run.hand))
    fmt::print("The hand is not tracked (--hand {}): suitable for rehearsals only.\n",
               given.run.hand);
  std::fflush(stdout);
  Observer observer(view, study, markers, interrupt);
  RunOptions options;
  options.seconds = kADay;
  options.live = &view.link();
  const RunSummary summary = run(pipeline, settings, options, observer);
  view.stop();
  write_rest(markers, session);
  if (summary.failure) return tell(summary.failure);
  print_session(stdout, session, file, summary, observer.plans(), settings);
  if (!given.markers.empty()) tell_delays(stdout, file, run_of(file));
  require_written(session, study_time().time);
  if (interrupt.requested()) return interrupt.status();
  return never_came(pipeline.world_stage().hands().tracker_status()) ? kNoFrame : 0;
}

}  // namespace prostm::app
