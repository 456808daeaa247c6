#pragma once
/// The protocol of a study as prostm study run presents it.

#include <string>

#include "options.hpp"
#include "prostm/study/task/protocol_file.hpp"

namespace prostm::app {

/// The settings that all methods begin with: those of a run in real time whose jets blow under the
/// palm. @throws InputError as make_settings() does.
PipelineSettings study_settings(const CommonOptions& common);

/// Reads a protocol, with the time that planning has in real time. @throws InputError as
/// read_protocol() does, and for a method that the device does not play as it is written.
Protocol live_protocol(const std::string& path, const PipelineSettings& base);

}  // namespace prostm::app
