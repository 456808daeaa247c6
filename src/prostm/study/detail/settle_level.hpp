#pragma once
/// [level] of a protocol.

#include <string>
#include <vector>

#include "prostm/study/protocol.hpp"

namespace prostm::study {

/// Checks and completes [level] of a protocol whose tables are read, and takes the standard out of
/// its methods. @param given the settings that the file gives, "level.low". @throws InputError: the
/// task has no levels, or lacks them; levels that are out of order, that the setting or the
/// procedure does not take, or that change nothing; a standard that is no method.
void settle_level(const std::vector<std::string>& given, const std::string& file,
                  Protocol& protocol);

}  // namespace prostm::study
