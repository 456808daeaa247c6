#pragma once
/// The interface of study tasks: the work of a participant in a trial.
///
/// A task is a class that derives from Task, and a line in a table (tasks.hpp). Protocols name it;
/// sessions, files, pages, rehearsals and the analysis use this interface alone.

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "prostm/core/random.hpp"
#include "prostm/core/text/names.hpp"
#include "prostm/study/protocol/order.hpp"
#include "prostm/study/protocol/protocol.hpp"
#include "prostm/study/task/answer_kind.hpp"
#include "prostm/study/task/procedures.hpp"
#include "prostm/study/task/study_act.hpp"

namespace prostm {

class Perception;

/// The form of an answer, and its number in files.
enum class AnswerForm : std::uint8_t {
  YesNo,     ///< yes is 1, no is 0
  Interval,  ///< one of the intervals, from 1
  Tuned      ///< no answer: the level is tuned and accepted
};
template <>
inline constexpr std::array<std::string_view, 3> kNames<AnswerForm> = {"yes-no", "interval",
                                                                       "tuned"};

/// Properties of a task.
struct TaskTraits {
  std::string_view name;  ///< in protocols, files and messages: "forced-choice"
  AnswerForm form = AnswerForm::YesNo;
  /// Button labels: yes and no for YesNo, one for each interval for Interval; none for Tuned.
  std::span<const std::string_view> words = {};
  std::string_view spoken = {};  ///< instruction for spoken answers; one sentence
  bool has_levels = true;        ///< [level] is read, and trials belong to tracks
  bool compares = false;         ///< some intervals present a standard
  int intervals = 1;             ///< intervals in a trial; for Tuned they repeat until it ends
  bool pictured = false;         ///< the participant's page draws the scene in question
  std::size_t least_scenes = 1;  ///< that a protocol must have
  /// Consecutive answers at an end of the range before the experimenter is notified.
  int answers_at_bound = 3;
};

/// The tracks of a scene with a method.
struct TrackPlan {
  int tracks = 1;
  int trials = 0;     ///< of a track; at most this many if open
  bool open = false;  ///< the track may end earlier
};

/// The intervals of one trial.
struct IntervalPlan {
  std::vector<bool> shows_level = {true};  ///< for each interval; false: it presents the standard
  double length = 0.0;                     ///< of an interval [s]; 0: lasts until the answer
  double gap = 0.0;                        ///< silence between two of them [s]
  bool in_turn = false;                    ///< repeat the intervals until the trial ends
  bool answer_after = false;               ///< an answer is taken only after all intervals
};

/// A study task. Stateless: one object serves all sessions.
class Task {
 public:
  explicit Task(const TaskTraits& traits) : traits_(traits) {}
  virtual ~Task() = default;
  Task(const Task&) = delete;
  Task& operator=(const Task&) = delete;

  const TaskTraits& traits() const { return traits_; }
  std::string name() const { return std::string(traits_.name); }
  bool is_tuned() const { return traits_.form == AnswerForm::Tuned; }

  // ---- protocols ----

  /// Checks a protocol whose standard was moved out of its methods. @throws std::invalid_argument
  /// with a sentence as message.
  virtual void check(const Protocol& protocol) const;

  // ---- trials ----

  /// All trials of a participant (numbered from 1), in order. For tasks without levels.
  virtual std::vector<Trial> trials(const Protocol& protocol, int participant) const;
  /// The tracks, for tasks with levels; by default, the staircases of [level].
  virtual TrackPlan tracks(const Protocol& protocol) const;
  /// The procedure of one track. @throws std::invalid_argument: settings that are invalid for it.
  virtual Procedure procedure(const Protocol& protocol, std::uint64_t seed) const;
  /// Draws the interval that presents the level, from 1; 0 if none does. For tasks with levels.
  virtual int draw_interval(Random& random) const;
  virtual IntervalPlan intervals(const Protocol& protocol, const Trial& trial) const;

  // ---- answers ----

  /// The number of an answer in files, or a sentence that says why the act is refused.
  virtual std::variant<int, std::string> answer_of(const StudyAct& act) const;
  /// The numbers of all answers, in the order of their buttons; empty for Tuned.
  std::vector<int> answers() const;
  /// Whether an answer is for the trial's level; without levels, whether it is yes.
  virtual bool felt(const Trial& trial, int answer) const = 0;
  /// Whether an answer is right. @pre answer_kind() is Right.
  virtual bool is_right(const Trial& trial, int answer) const { return felt(trial, answer); }
  /// The meaning of answers. @param other_standard whether the standard is a method of its own.
  virtual AnswerKind answer_kind(bool other_standard) const = 0;
  /// Guess rate: the share of answers for the level when guessing, 0..1.
  double guess(const Protocol& protocol) const;

  // ---- files ----

  /// Adds the stimulus to a trial's line: method, scene, and the question or the level with its
  /// standard.
  virtual void add_stimulus(nlohmann::ordered_json& line, const Protocol& protocol,
                            const Trial& trial) const;
  /// Adds an answer to a trial's line: its number, and its meaning.
  virtual void add_answer(nlohmann::ordered_json& line, const Protocol& protocol,
                          const Trial& trial, int answer) const;

  // ---- rehearsals ----

  /// The next act of a simulated observer in a trial with a level: an answer, or a step of tuning.
  virtual StudyAct respond(const Trial& trial, Perception& perception) const;
  /// An answer drawn at random. @pre the task is not Tuned.
  StudyAct guessed(Random& random) const;
  /// The act that gives the answer of this number.
  StudyAct act_of(int answer) const;

 private:
  TaskTraits traits_;
};

}  // namespace prostm
