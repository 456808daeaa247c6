#pragma once
/// Trials that are not part of the course, and whose answers are not results: practice, catch
/// trials and attention trials.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "prostm/core/text/names.hpp"
#include "prostm/study/extra/practice.hpp"
#include "prostm/study/protocol/order.hpp"

namespace prostm {

/// Names are the kinds of their lines in participants' files.
enum class ExtraKind : std::uint8_t {
  Practice,
  Catch,     ///< presents nothing; the right answer is no
  Attention  ///< asks for a certain answer in place of the question
};
template <>
inline constexpr std::array<std::string_view, 3> kNames<ExtraKind> = {"practice", "catch",
                                                                      "attention"};

struct ExtraTrial {
  ExtraKind kind = ExtraKind::Practice;
  Trial trial;                     ///< what is presented, unless it is a catch trial
  std::optional<int> wanted = {};  ///< the right answer, as in files; not set in practice
};

/// The extra trials of one participant. They depend on the protocol, the participant and the number
/// of answers, not on time.
class ExtraTrials {
 public:
  /// @pre the protocol outlives this.
  ExtraTrials(const Protocol& protocol, int participant)
      : protocol_(protocol), participant_(participant), practice_(protocol.practice) {}

  /// Begins the practice of a method.
  void begin_practice() { practice_.begin(); }
  /// Returns the extra trial that is due before a trial of the course, if any.
  /// @param done trials of the course so far. @param next the trial of the course.
  std::optional<ExtraTrial> next(std::size_t done, const Trial& next) const;
  /// Records the answer to an extra trial. @param right of right_answer().
  void answer(ExtraKind kind, std::size_t done, bool right);

  bool practises() const { return !practice_.is_done(); }
  const Practice& practice() const { return practice_; }
  /// Whether an answer is right; nothing if the task has no right answers.
  std::optional<bool> right_answer(const ExtraTrial& extra, int answer) const;
  /// The instruction of an attention trial, in place of the question.
  std::string instruction(const ExtraTrial& extra) const;

 private:
  bool is_due(ExtraKind kind, int every, std::size_t done) const;
  Trial drawn(Random& random, const Trial& next) const;
  Random random_of(ExtraKind kind, std::size_t index) const;

  const Protocol& protocol_;
  const int participant_;
  Practice practice_;
  /// By ExtraKind: trials of the course before the last one given, plus 1; 0 before the first.
  std::array<std::size_t, kNames<ExtraKind>.size()> given_{};
};

/// Checks the settings of extra trials against the task. @throws std::invalid_argument with a
/// sentence.
void validate_extra_trials(const Protocol& protocol);

}  // namespace prostm
