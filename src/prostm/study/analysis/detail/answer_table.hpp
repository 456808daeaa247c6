#pragma once
/// Reads answers from tables of separated values.

#include <string>
#include <string_view>
#include <vector>

#include "prostm/study/analysis/answer.hpp"

namespace prostm::study {

/// Reads a table in UTF-8. @param columns as for column_map(). @param notes receives sentences
/// about rows and values that were skipped or reinterpreted. @throws InputError as
/// answers_from_csv().
std::vector<Answer> read_answer_table(std::string_view text, const std::string& file,
                                      const std::string& columns, std::vector<std::string>& notes);

}  // namespace prostm::study
