#pragma once
/// Who and what the names of answers mean: participants, methods and scenes.

#include <span>
#include <string>
#include <vector>

#include "prostm/study/analysis/answer.hpp"
#include "prostm/study/analysis/reading_settings.hpp"

namespace prostm::study {

/// Returns for each path what tells it from the others: the parts of its folder's path, or of its
/// own without its ending, that not all have in common at the beginning and at the end.
std::vector<std::string> distinct_parts(std::span<const std::string> paths, IdPrefix prefix);

/// Gives names other names. @param renames "participant:OLD=NEW", also of methods and scenes.
/// @throws InputError: no such form or no such name.
void rename(std::vector<Answer>& answers, std::span<const std::string> renames);

/// Finds participants, methods and scenes whose names differ in spelling alone (spelling_key()).
/// @param merge they are one, with the name that comes first, and a note. @throws InputError: there
/// are such names, and merge is false.
void settle_spellings(std::vector<Answer>& answers, bool merge, std::vector<std::string>& notes);

}  // namespace prostm::study
