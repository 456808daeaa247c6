#pragma once
/// An answer of a participant, as the analysis takes it.

#include <optional>
#include <string>

#include "prostm/study/task/answer_kind.hpp"

namespace prostm {

/// The run that an answer is from; each part is empty where it is not known.
struct RunFacts {
  std::string protocol;  ///< checksum of all of it
  std::string version, device, array, hand;

  bool operator==(const RunFacts&) const = default;
};

/// One trial of one participant, with the answer unless that is missing.
struct Answer {
  std::string participant, method;
  std::string scene;                 ///< the stimulus
  bool correct = false;              ///< of kind Felt: for the level
  std::string question = {};         ///< the scene that was asked for; empty where it is not known
  bool yes = false;                  ///< the answer to it
  std::string trial = {};            ///< empty where it is not known
  std::optional<double> level = {};  ///< of the stimulus, where it was varied
  AnswerKind kind = AnswerKind::Right;
  bool answered =
      true;  ///< false: no answer was given, and correct, question and yes are not known
  std::optional<double> response_s = {};  ///< time to the answer [s], where it is known
  std::string stimulus = {};              ///< checksum of its settings, where it is known
  std::string gate =
      {};  ///< of the stimulus: "pass", "fail", "anyway"; empty where it was not asked
  RunFacts run = {};

  bool operator==(const Answer&) const = default;
};

}  // namespace prostm
