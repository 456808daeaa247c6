#pragma once
/// The session of one participant: a state machine without threads or clocks. It receives events
/// and returns the stimulus to present.

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
#include "prostm/study/extra/extra_trials.hpp"
#include "prostm/study/session/page_watch.hpp"
#include "prostm/study/session/response_file.hpp"
#include "prostm/study/session/study_sight.hpp"
#include "prostm/study/task/course.hpp"
#include "prostm/study/task/intervals.hpp"
#include "prostm/study/task/study_act.hpp"

namespace prostm {

enum class StudyPhase : std::uint8_t {
  Consent,   ///< the participant reads the consent form, and agrees or leaves
  About,     ///< the participant's answers about themselves
  Training,  ///< the participant explores the scenes
  Ready,     ///< before the practice or the first trial of a method, and after a crash
  Settling,  ///< silence while the smoke develops, until the gate passes and the participant's page
             ///< is ready
  Presenting,  ///< the stimulus is presented, and the question asked
  Break,
  Paused,
  Done,      ///< all answers were given
  Withdrawn  ///< the participant left
};
template <>
inline constexpr std::array<std::string_view, 10> kNames<StudyPhase> = {
    "consent",    "about", "training", "ready", "settling",
    "presenting", "break", "paused",   "done",  "withdrawn"};

/// The stimulus to present.
struct StudyWanted {
  int method = 0, scene = -1;  ///< indices into the protocol; scene −1: still air
  bool sound = false;
  bool picture = false;              ///< the participant sees the simulation
  std::optional<double> level = {};  ///< level of the varied setting
  bool standard = false;             ///< present the protocol's standard instead of the method
  bool operator==(const StudyWanted&) const = default;
};

/// The participant whom this one replaces.
struct Replacement {
  std::string participant;  ///< the participant replaced
  int order = 0;            ///< number that sets their methods and orders
};

class StudySession {
 public:
  /// Resumes the session of the file, or begins a new file. Protocol and file must outlive this.
  /// @param facts the facts about the run for the first line: version, device, limits.
  /// @param replaces the participant whose methods and orders this one gets, instead of their own.
  /// @throws InputError: the file belongs to another protocol or participant, or is complete.
  StudySession(const Protocol& protocol, int participant, ResponseFile& file,
               const nlohmann::ordered_json& facts, const StudySight& now,
               const std::optional<Replacement>& replaces = {});

  /// Advances to the time of `sight`. @return the stimulus to present from now on.
  const StudyWanted& look(const StudySight& sight);

  /// Performs an act. @return an empty text, or a sentence that says why it was refused or not
  /// written. An answer that could not be written is kept and written first at the next attempt.
  std::string take(const StudyAct& act, const StudySight& sight);

  /// Records a marker that was sent. @return as take() does.
  std::string note(ResponseLine marker, const StudySight& sight) {
    return write(std::move(marker), sight);
  }

  /// Tries once more to write the unwritten lines. @return as take() does.
  std::string finish(double time) { return write_rest(time); }
  /// Lines that could not yet be written.
  const std::vector<ResponseLine>& unwritten() const { return unwritten_; }

  StudyPhase phase() const { return phase_; }
  const StudyWanted& wanted() const { return wanted_; }
  const Protocol& protocol() const { return protocol_; }
  int participant() const { return participant_; }
  bool closed() const { return closed_; }                     ///< the run may end
  std::size_t trials_done() const { return course_.done(); }  ///< without extra trials
  const Course& course() const { return course_; }
  /// The next trial, or the one in progress. @pre not all trials are done.
  const Trial& trial() const { return extra_ ? extra_->trial : course_.trial(); }
  /// Set while the trial is not one of the course.
  const std::optional<ExtraTrial>& extra() const { return extra_; }
  /// Whether a catch trial stands for a stimulus now.
  bool presents_nothing() const;
  /// The number of the current or next practice trial, from 1; 0 if none follows.
  int practice_trial() const;
  /// A sentence about a practice that ended without its criterion; empty after the next act.
  const std::string& practice_failed() const { return practice_failed_; }
  /// The question of the trial, or the instruction of an attention trial.
  std::string question() const;
  /// The current interval of the trial, from 1; 0 during silence, or if there is only one.
  int interval() const { return phase_ == StudyPhase::Presenting ? intervals_.interval() : 0; }
  /// Whether an answer can be given now.
  bool takes_answer() const {
    return phase_ == StudyPhase::Presenting && intervals_.takes_answer();
  }
  double training_left() const { return training_left_; }  ///< [s]
  int explored() const { return explored_; }               ///< current scene in Training
  const std::optional<GateResult>& gate() const { return gate_; }
  /// The number of the last answer, as in files; nothing before the first.
  std::optional<int> last_answer() const { return last_; }
  /// The reason why the trial cannot begin yet; empty if it can.
  const std::string& waits_for() const { return waits_for_; }
  /// A sentence about the first unmet need of the participant's page, with the remedy; empty if
  /// none.
  std::string page_problem() const { return sentence(page_.told()); }
  /// A sentence about staircases at an end of their range; empty if no staircase is.
  std::string at_bound() const;
  /// Takes the oldest pending message for the experimenter; false if no message is pending.
  bool next_news(std::string& sentence);
  /// Whether the last answer was right; nothing before the first, or without feedback.
  std::optional<bool> feedback() const { return feedback_; }
  /// The message of a failed write, until one succeeds.
  const std::string& problem() const { return problem_; }
  /// The largest relative difference in rendered force (Eq. (1)) between two scenes of one method,
  /// over the larger force: a difference that could reveal the scene. Methods are not compared: all
  /// have the same scenes, and Eq. (1) does not measure their strengths equally. 0 if trials have
  /// levels.
  double strength_difference() const;
  /// A sentence if this exceeds the protocol's limit, else empty.
  std::string strengths() const;

 private:
  struct Strength {
    double target = 0.0, rendered = 0.0;  // sums over samples [N]
    int looks = 0;
  };
  struct Played {
    double speed = 0.0, period = 0.0;  // sums over samples [m/s], [s]
    int looks = 0, changed = 0;        // changed: largest number of paths
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
  std::string explore(int scene);
  bool is_resting() const;
  std::string go_on(const StudySight& sight);
  std::string end_training(const StudySight& sight);
  std::string end_extra(int answer, const StudySight& sight);
  std::string end_practice(const StudySight& sight);
  std::string practise_again(const StudySight& sight);
  void repeat_extra(ExtraKind kind, const ResponseLine& line);
  std::string write(ResponseLine line, const StudySight& sight);
  std::string write_rest(double time);
  void add_strength(const Trial& trial, double target, double rendered);
  void watch_clock(const StudySight& sight);
  ResponseLine trial_line(std::optional<int> answer, const StudySight& sight) const;
  bool starts_method() const;

  const Protocol& protocol_;
  const int participant_;
  ResponseFile& file_;
  Course course_;  // with the recorded answers
  ExtraTrials extras_;
  std::optional<ExtraTrial> extra_;
  std::string practice_failed_;
  Intervals intervals_;
  std::optional<Trial> last_trial_;  // the last one answered
  StudyPhase phase_ = StudyPhase::Ready;
  StudyWanted wanted_;
  double since_ = 0.0;         // start of the phase [s]
  double in_force_at_ = -1.0;  // when the wanted stimulus came into force; −1: it has not
  double training_left_ = 0.0, looked_ = 0.0;  // [s]
  int explored_ = 0;
  bool anyway_ = false;    // the gate is overridden
  PageNeeds passed_over_;  // needs of the page that were overridden
  PageWatch page_;
  bool closed_ = false;
  std::optional<GateResult> gate_, gate_at_onset_;
  std::string waits_for_, problem_;
  std::optional<bool> feedback_;
  std::optional<int> last_;
  std::vector<ResponseLine> unwritten_;
  std::vector<std::string> news_;
  double tried_ = 0.0;                // time of the last attempt to write [s]
  double utc_offset_ = 0.0;           // Unix time minus the steady clock [s]
  Strength strength_;                 // of the trial
  Played played_;                     // of the trial
  std::vector<Strength> strengths_;   // sums over trials, for each method and scene
  std::optional<double> begun_with_;  // initial level of the trial
  nlohmann::ordered_json changes_;    // level changes of the trial: [s, level]
  nlohmann::ordered_json hand_;       // poses during the trial: [s, x, y, z in mm, quaternion]
  double hand_at_ = 0.0, hand_gone_ = 0.0;  // [s]
};

}  // namespace prostm
