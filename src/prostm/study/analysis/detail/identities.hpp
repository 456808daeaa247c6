#pragma once
/// Resolves names of participants, methods and scenes in answers.

#include <span>
#include <string>
#include <vector>

#include "prostm/study/analysis/answer.hpp"
#include "prostm/study/analysis/reading_settings.hpp"

namespace prostm::study {

/// Returns the distinguishing part of each path: the path of its folder, or its own without
/// extension, minus the leading and trailing parts common to all.
std::vector<std::string> distinct_parts(std::span<const std::string> paths, IdPrefix prefix);

/// Renames. @param renames "participant:OLD=NEW", or with method: or scene:. @throws InputError:
/// another form, or no such name.
void rename(std::vector<Answer>& answers, std::span<const std::string> renames);

/// Finds participants, methods and scenes whose names differ only in spelling (spelling_key()).
/// @param merge treat them as one, under the first name, with a note. @throws InputError: there are
/// such names, and merge is false.
void settle_spellings(std::vector<Answer>& answers, bool merge, std::vector<std::string>& notes);

}  // namespace prostm::study
