#pragma once
/// Answers in participants' files.

#include <string>
#include <string_view>
#include <vector>

#include "prostm/study/analysis/answer.hpp"
#include "prostm/study/analysis/detail/same_stimuli.hpp"
#include "prostm/study/task/tasks.hpp"

namespace prostm::study {

/// A participant's file: answers, and what they are compared by.
struct Responses {
  std::vector<Answer> answers;
  StudyFile file;
  int trials = 0;  ///< that the protocol has
  bool ended = false;
};

/// Reads a participant's file. @param tasks those whose names are known. @param notes gets
/// sentences about rehearsals, strengths, and trials without answers. @throws InputError: what
/// responses_from_text() throws; no first line of a study, a task that is not known, a trial
/// without its values.
Responses read_responses(std::string_view text, const std::string& file, Tasks tasks,
                         std::vector<std::string>& notes);

}  // namespace prostm::study
