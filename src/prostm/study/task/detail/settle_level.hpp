#pragma once
/// [level] of a protocol.

#include <string>
#include <string_view>
#include <vector>

#include "prostm/study/protocol/protocol.hpp"

namespace prostm::study {

/// Checks and completes [level] of a protocol whose tables are read, and takes the standard out of
/// its methods. @param given the settings that the file gives, "level.low". @param text of the
/// file.
/// @throws InputError: the task has no levels, or lacks them; levels that are out of order, that
/// the setting or the procedure does not take, that are not played as written, or that change
/// nothing; a standard that is no method.
void settle_level(const std::vector<std::string>& given, const std::string& file,
                  std::string_view text, Protocol& protocol);

/// Checks that the device plays a method as it is written. @throws InputError that names the
/// method.
void require_playable_method(const StudyMethod& method, const std::string& file,
                             std::string_view text);

}  // namespace prostm::study
