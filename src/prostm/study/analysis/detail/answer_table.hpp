#pragma once
/// Answers from tables of separated values.

#include <string>
#include <string_view>
#include <vector>

#include "prostm/study/analysis/answer.hpp"

namespace prostm::study {

/// Reads a table in UTF-8. @param columns as column_map() reads it. @param notes gets sentences
/// about what was left out or taken as something else.
/// @throws InputError as answers_from_csv() does.
std::vector<Answer> read_answer_table(std::string_view text, const std::string& file,
                                      const std::string& columns, std::vector<std::string>& notes);

}  // namespace prostm::study
