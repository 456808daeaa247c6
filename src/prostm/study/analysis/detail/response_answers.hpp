#pragma once
/// Reads answers from participants' files.

#include <string>
#include <string_view>
#include <vector>

#include "prostm/study/analysis/answer.hpp"
#include "prostm/study/analysis/detail/same_stimuli.hpp"
#include "prostm/study/task/tasks.hpp"

namespace prostm::study {

/// A participant's file: its answers, and data for comparing stimuli.
struct Responses {
  std::vector<Answer> answers;
  StudyFile file;
  int trials = 0;  ///< number of trials in the protocol
  bool ended = false;
};

/// Reads a participant's file. @param tasks the known tasks. @param notes receives sentences about
/// rehearsals, strengths, and trials without answers. @throws InputError: as responses_from_text();
/// a first line that is not a study's, an unknown task, a trial with missing values.
Responses read_responses(std::string_view text, const std::string& file, Tasks tasks,
                         std::vector<std::string>& notes);

}  // namespace prostm::study
