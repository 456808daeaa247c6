#pragma once
/// [level] of a protocol.

#include <string>
#include <string_view>
#include <vector>

#include "prostm/study/protocol/protocol.hpp"

namespace prostm::study {

/// Checks and completes [level] of a protocol whose tables have been read, and moves the standard
/// out of its methods. @param given names of the settings in the file, e.g. "level.low". @param
/// text content of the file.
/// @throws InputError: [level] given for a task without levels, or missing; levels that are out of
/// order, invalid for the setting or the procedure, altered when played, or without effect; a
/// standard that is not a method.
void settle_level(const std::vector<std::string>& given, const std::string& file,
                  std::string_view text, Protocol& protocol);

/// Checks that the device plays a method exactly as written. @throws InputError naming the method.
void require_playable_method(const StudyMethod& method, const std::string& file,
                             std::string_view text);

}  // namespace prostm::study
