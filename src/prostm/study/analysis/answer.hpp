#pragma once
/// An answer of a participant, as input to the analysis.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "prostm/study/task/answer_kind.hpp"

namespace prostm {

/// The run of an answer; unknown fields are empty.
struct RunFacts {
  std::string protocol;  ///< checksum of the whole protocol
  std::string version, device, array, hand;

  bool operator==(const RunFacts&) const = default;
};

/// One trial of one participant, with the answer unless that is missing.
struct Answer {
  std::string participant, method;
  std::string scene;                 ///< the stimulus
  bool correct = false;              ///< for kind Felt: for the level
  std::string question = {};         ///< the scene in question; empty if unknown
  bool yes = false;                  ///< the answer to the question
  std::string trial = {};            ///< empty if unknown
  std::optional<double> level = {};  ///< level of the stimulus, if it was varied
  AnswerKind kind = AnswerKind::Right;
  bool answered = true;  ///< false: no answer was given; correct, question and yes are unknown
  std::optional<double> response_s = {};  ///< response time [s], if known
  std::string stimulus = {};              ///< checksum of its settings, if known
  std::string gate = {};  ///< of the stimulus: "pass", "fail", "anyway"; empty if not evaluated
  RunFacts run = {};
  /// All else in the file about the trial: names of columns, and their cells. The analysis does not
  /// use it. No name is that of a column that answers_from_csv() reads.
  std::vector<std::pair<std::string, std::string>> other = {};

  bool operator==(const Answer&) const = default;
};

}  // namespace prostm
