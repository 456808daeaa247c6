#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <utility>

#include "common.hpp"
#include "prostm/commit.hpp"
#include "prostm/core/distribution.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/pipeline/runner.hpp"
#include "prostm/study/session/roster.hpp"
#include "prostm/study/session/session.hpp"
#include "prostm/study/session/spelling.hpp"
#include "prostm/study/task/line_keys.hpp"
#include "run/run_quality.hpp"
#include "run/view.hpp"
#include "study/study_protocol.hpp"

namespace prostm::app {
namespace {

constexpr int kMostParticipants = 9999;
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

/// Plans of the stimuli of a session, those of paths and those of stationary foci.
class SessionPlans {
 public:
  void offer(const WorldFrame& contact, const PlanFrame& plan) {
    if (plan.status != PlanStatus::Planned) return;
    const Method kind = plan.plan.foci.empty() ? Method::ProStm : Method::Am;
    plans_[static_cast<std::size_t>(kind)].offer(contact, plan);
  }
  /// Prints their quality, which takes about a second for each of the two.
  /// @param settings of the session; those of the output are the protocol's.
  void print_quality(std::FILE* out, PipelineSettings settings, const Protocol& protocol) const {
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

 private:
  std::array<PlanSample, 2> plans_;  // by Method
};

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

/// The number that --participant gives; 01 is 1. @throws InputError: it is not a number, or out of
/// range.
int participant_of(const StudyRunOptionsGiven& given) {
  const std::string id = study::trimmed(given.participant);
  int number = 0;
  const auto [end, wrong] = std::from_chars(id.data(), id.data() + id.size(), number);
  if (wrong != std::errc() || end != id.data() + id.size() || number < 1 ||
      number > kMostParticipants) {
    throw InputError(fmt::format("--participant {} must be a number between 1 and {}",
                                 given.participant, kMostParticipants));
  }
  return number;
}

/// Returns the participant's file. @throws InputError: the participant has begun but --resume is
/// not given, or the other way round; the folder cannot be made.
std::string file_of(const StudyRunOptionsGiven& given, int participant) {
  if (given.rehearse && *given.rehearse < 0)
    throw InputError(fmt::format("--rehearse {} must be 0 or more trials", *given.rehearse));
  std::error_code wrong;
  std::filesystem::create_directories(given.folder, wrong);
  if (wrong) {
    throw InputError(
        fmt::format("--answers {} cannot be a folder: {}", given.folder, wrong.message()));
  }
  const char* kind = given.rehearse ? "rehearsal" : "participant";
  const std::string path =
      (std::filesystem::path(given.folder) / fmt::format("{}-{}.jsonl", kind, participant))
          .string();
  const bool begun = std::filesystem::exists(path) && !std::filesystem::is_empty(path);
  if (begun && !given.resume) {
    throw InputError(
        fmt::format("participant {} has begun ({}); use another number for a new one, or --resume "
                    "to continue with this one",
                    participant, path));
  }
  if (!begun && given.resume) {
    throw InputError(fmt::format("participant {} has not begun: there is no {}; leave --resume out",
                                 participant, path));
  }
  return path;
}

/// Returns all who have a file in the folder, or have rehearsed. Files that cannot be read are
/// ignored: they must not stop another participant.
std::vector<RosterEntry> roster_of(const StudyRunOptionsGiven& given) {
  std::vector<std::string> faults;
  auto roster = read_roster(response_files_in(given.folder), &faults);
  std::erase_if(roster,
                [&](const RosterEntry& e) { return e.rehearsal != given.rehearse.has_value(); });
  return roster;
}

/// Returns the participant whom this one replaces, if any.
/// @throws InputError: the participant has another file; the one to replace does not exist, was
/// replaced before, or belongs to another protocol.
std::optional<Replacement> replacement_for(const StudyRunOptionsGiven& given, int participant,
                                           const std::string& path, const Protocol& protocol) {
  const std::vector<RosterEntry> roster = roster_of(given);
  const RosterEntry* self = find_participant(roster, std::to_string(participant));
  if (self != nullptr && self->file != path) {
    throw InputError(
        fmt::format("participant {} has begun in {}; use another number for the new one, or rename "
                    "that file to "
                    "{} to continue with it",
                    participant, self->file, path));
  }
  if (self != nullptr && (given.replaces.empty() || study::spelling_key(given.replaces) ==
                                                        study::spelling_key(self->replaces))) {
    if (self->replaces.empty()) return {};
    return Replacement{self->replaces, self->order};
  }
  if (self != nullptr) {
    throw InputError(fmt::format(
        "participant {} began {}; leave --replaces out", participant,
        self->replaces.empty() ? "without --replaces" : "with --replaces " + self->replaces));
  }
  if (given.replaces.empty()) return {};
  const RosterEntry* replaced = find_participant(roster, given.replaces);
  if (replaced == nullptr) {
    throw InputError(fmt::format(
        "--replaces {}: no participant of this number has a file in {}; prostm study status lists "
        "them",
        given.replaces, given.folder));
  }
  if (const RosterEntry* by = replacement_of(roster, *replaced)) {
    throw InputError(fmt::format("participant {0} was replaced by {1} before; give --replaces {1}",
                                 replaced->participant, by->participant));
  }
  if (replaced->protocol != protocol_json(protocol)) {
    throw InputError(
        fmt::format("participant {} had another protocol than {}, so their place does "
                    "not belong to this study",
                    replaced->participant, given.protocol));
  }
  return Replacement{replaced->participant, replaced->order};
}

std::optional<Rehearsal> rehearsal_of(const StudyRunOptionsGiven& given, int participant) {
  if (!given.rehearse) return {};
  return Rehearsal(static_cast<std::size_t>(*given.rehearse),
                   static_cast<std::uint64_t>(participant));
}

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

std::size_t answers_in(const std::vector<ResponseLine>& lines) {
  return static_cast<std::size_t>(std::ranges::count_if(
      lines, [](const ResponseLine& l) { return l.value(line::kKind, "") == line::kTrial; }));
}

void report(std::FILE* out, const StudySession& session, const ResponseFile& file,
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

}  // namespace

int study_run_command(const StudyRunOptionsGiven& given) {
  if (given.run.hand == "page")
    throw InputError(
        "--hand page needs the page of a run; the pages of a study cannot move a hand");
  PipelineSettings base = study_settings(given.run.common);
  settle_hand(given.run.hand, given.run.hand_size, base);
  check_mode(base, RunMode::RealTime);
  const Protocol protocol = live_protocol(given.protocol, base);
  const int participant = participant_of(given);
  const std::string path = file_of(given, participant);
  const auto replaces = replacement_for(given, participant, path, protocol);
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
  ResponseFile file(path, given.take_over ? ForeignLock::Replaced : ForeignLock::Respected);
  if (!file.lock_notice().empty()) warn(file.lock_notice());
  const bool begins = file.lines().empty();
  const nlohmann::ordered_json facts = {{"prostm", version_text()},
                                        {"device", settings.device},
                                        {"array", settings.array},
                                        {"hand", given.run.hand},
                                        {"rehearsal", given.rehearse.has_value()}};
  StudySession session(protocol, participant, file, facts, study_time(), replaces);
  MarkerSender markers(std::move(targets), protocol, {participant, run_of(file)}, pipeline.device(),
                       pipeline.sound());
  const PagesEnd pages_end(view);
  StudyView& study = serve(given, pipeline, session, markers, view, begins ? path : "");
  if (file.found_cut_off())
    fmt::print("The last line of {0} was cut off; it is in {0}.cut-off.\n", path);
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
  const std::string unwritten = session.finish(study_time().time);
  report(stdout, session, file, summary, observer.plans(), settings);
  if (!given.markers.empty()) tell_delays(stdout, file, run_of(file));
  if (!unwritten.empty()) {
    throw InputError(fmt::format("{}; lost answers: {}; continue with --resume", unwritten,
                                 answers_in(session.unwritten())));
  }
  if (interrupt.requested()) return interrupt.status();
  return never_came(pipeline.world_stage().hands().tracker_status()) ? kNoFrame : 0;
}

}  // namespace prostm::app
