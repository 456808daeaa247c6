#pragma once
/// One participant's way through a study: a state without threads or clocks, which is told what
/// happens and says what is to be presented.

#include <array>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "prostm/core/text/names.hpp"
#include "prostm/stimulus/stimulus_gate.hpp"
#include "prostm/study/session/page_watch.hpp"
#include "prostm/study/session/response_file.hpp"
#include "prostm/study/session/study_sight.hpp"
#include "prostm/study/task/course.hpp"
#include "prostm/study/task/intervals.hpp"
#include "prostm/study/task/study_act.hpp"

namespace prostm {

enum class StudyPhase : std::uint8_t {
  Consent,     ///< the participant reads, and agrees or leaves
  About,       ///< the participant's answers about themselves
  Training,    ///< scenes are explored
  Ready,       ///< before the first trial of a method, and after a pause or a crash
  Settling,    ///< silence: the smoke develops; the gate and the participant's page are waited for
  Presenting,  ///< the stimulus is felt, and asked about
  Break,
  Paused,
  Done,      ///< all answers are there
  Withdrawn  ///< the participant left
};
template <>
inline constexpr std::array<std::string_view, 10> kNames<StudyPhase> = {
    "consent",    "about", "training", "ready", "settling",
    "presenting", "break", "paused",   "done",  "withdrawn"};

/// The stimulus that is to be presented.
struct StudyWanted {
  int method = 0, scene = -1;  ///< places in the protocol; scene −1: still air
  bool sound = false;
  bool picture = false;              ///< the participant sees the simulation
  std::optional<double> level = {};  ///< of the setting that is varied
  bool standard = false;             ///< the protocol's standard, in place of the method
  bool operator==(const StudyWanted&) const = default;
};

/// The place of a participant who is replaced.
struct Replacement {
  std::string participant;  ///< who had it
  int order = 0;            ///< number whose methods and orders they had
};

class StudySession {
 public:
  /// Goes on where the file ends; a new file gets its first line. Both must outlive this.
  /// @param facts of the run for the first line: version, device, limits.
  /// @param replaces whose methods and orders this participant gets, in place of their own.
  /// @throws InputError: the file is of another protocol or participant, or has all answers.
  StudySession(const Protocol& protocol, int participant, ResponseFile& file,
               const nlohmann::ordered_json& facts, const StudySight& now,
               const std::optional<Replacement>& replaces = {});

  /// Time passes. @return what is to be presented from now on.
  const StudyWanted& look(const StudySight& sight);

  /// @return an empty text, or the sentence that says why not. An answer that could not be written
  /// is kept, and written before anything else happens.
  std::string take(const StudyAct& act, const StudySight& sight);

  /// Writes down a marker that was sent. @return as take() does.
  std::string note(ResponseLine marker, const StudySight& sight) {
    return write(std::move(marker), sight);
  }

  /// Tries once more to write what could not be written. @return as take() does.
  std::string finish(double time) { return write_rest(time); }
  /// Lines that could not be written so far.
  const std::vector<ResponseLine>& unwritten() const { return unwritten_; }

  StudyPhase phase() const { return phase_; }
  const StudyWanted& wanted() const { return wanted_; }
  const Protocol& protocol() const { return protocol_; }
  int participant() const { return participant_; }
  bool closed() const { return closed_; }  ///< the run may end
  std::size_t trials_done() const { return course_.done(); }
  const Course& course() const { return course_; }
  /// The trial that is next or under way. @pre not all are done.
  const Trial& trial() const { return course_.trial(); }
  /// The interval of a trial that sounds, from 1; 0 in silence, and where a trial has only one.
  int interval() const { return phase_ == StudyPhase::Presenting ? intervals_.interval() : 0; }
  /// Whether an answer is taken now.
  bool takes_answer() const {
    return phase_ == StudyPhase::Presenting && intervals_.takes_answer();
  }
  double training_left() const { return training_left_; }  ///< [s]
  int explored() const { return explored_; }               ///< scene of Training
  const std::optional<GateResult>& gate() const { return gate_; }
  /// The number of the last answer, as files have it; nothing before the first.
  std::optional<int> last_answer() const { return last_; }
  /// Why the trial does not begin, as things are; empty where it does.
  const std::string& waits_for() const { return waits_for_; }
  /// A sentence on the first need that the participant's page lacks, with the remedy; else empty.
  std::string page_problem() const { return sentence(page_.told()); }
  /// Staircases that stand at an end of their range, in a sentence; empty if none does.
  std::string at_bound() const;
  /// Reads the oldest sentence for the experimenter that was not read yet; false without one.
  bool next_news(std::string& sentence);
  /// Whether the last answer was right; nothing before the first and without feedback.
  std::optional<bool> feedback() const { return feedback_; }
  /// The sentence of a write that failed, until one succeeds.
  const std::string& problem() const { return problem_; }
  /// The largest difference in rendered force (Eq. (1)) between the scenes of one method, over the
  /// larger: a cue to which scene it is. Methods are not compared: they have the same scenes, and
  /// Eq. (1) does not measure their strengths alike. 0 where trials have levels.
  double strength_difference() const;
  /// A sentence where this is more than the protocol allows, else empty.
  std::string strengths() const;

 private:
  struct Strength {
    double target = 0.0, rendered = 0.0;  // sums over looks [N]
    int looks = 0;
  };
  struct Played {
    double speed = 0.0, period = 0.0;  // sums over looks [m/s], [s]
    int looks = 0, changed = 0;        // changed: most paths
  };

  const Task& task() const { return *protocol_.trials.task; }
  ResponseLine first_line(const std::optional<Replacement>& replaces) const;
  void begin_file(const ResponseLine& first, const nlohmann::ordered_json& facts,
                  const StudySight& now);
  void resume_file(const ResponseLine& first, const StudySight& now);
  void require_same_study(const ResponseLine& first) const;
  void require_open(StudyPhase phase) const;
  StudyPhase replay();
  void pass_consent(double time);
  void enter(StudyPhase phase, double time);
  void begin_method(double time);
  void settle(const StudySight& sight);
  void present(const StudySight& sight);
  void watch_page(const StudySight& sight);
  PageTask page_task() const;
  void note_bound(const StudySight& sight);
  void repeat_trial(const ResponseLine& line);
  void repeat_correction(const ResponseLine& line);
  StudyWanted still_air() const;
  StudyWanted exploring(bool sound) const;
  StudyWanted stimulus(bool level, bool sound) const;
  void add_played(const StudySight& sight);
  nlohmann::ordered_json played_json() const;
  std::string answer(const StudyAct& act, const StudySight& sight);
  std::string tune(const StudyAct& act, const StudySight& sight);
  std::string accept(const StudySight& sight);
  void end_trial(const ResponseLine& line, const StudySight& sight,
                 const std::function<void()>& count);
  std::string correct(const StudySight& sight);
  std::string end_training(const StudySight& sight);
  std::string write(ResponseLine line, const StudySight& sight);
  std::string write_rest(double time);
  void add_strength(const Trial& trial, double target, double rendered);
  void watch_clock(const StudySight& sight);
  ResponseLine trial_line(std::optional<int> answer, const StudySight& sight) const;
  bool starts_method() const;

  const Protocol& protocol_;
  const int participant_;
  ResponseFile& file_;
  Course course_;  // with the answers that are on the disk
  Intervals intervals_;
  std::optional<Trial> last_trial_;  // that was answered
  StudyPhase phase_ = StudyPhase::Ready;
  StudyWanted wanted_;
  double since_ = 0.0;         // the phase began [s]
  double in_force_at_ = -1.0;  // since when what is wanted is, in Settling; −1: it is not
  double training_left_ = 0.0, looked_ = 0.0;  // [s]
  int explored_ = 0;
  bool anyway_ = false;    // the gate is passed over
  PageNeeds passed_over_;  // and what the page lacked then
  PageWatch page_;
  bool closed_ = false;
  std::optional<GateResult> gate_, gate_at_onset_;
  std::string waits_for_, problem_;
  std::optional<bool> feedback_;
  std::optional<int> last_;
  std::vector<ResponseLine> unwritten_;
  std::vector<std::string> news_;
  double tried_ = 0.0;                      // to write them [s]
  double utc_offset_ = 0.0;                 // of the two clocks [s]
  Strength strength_;                       // of the trial
  Played played_;                           // of the trial
  std::vector<Strength> strengths_;         // of each method and scene, over trials
  std::optional<double> begun_with_;        // level of the trial
  nlohmann::ordered_json changes_;          // of it: [s, level]
  nlohmann::ordered_json hand_;             // of the trial: [s, x, y, z in mm, quaternion]
  double hand_at_ = 0.0, hand_gone_ = 0.0;  // [s]
};

}  // namespace prostm
