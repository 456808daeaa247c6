#pragma once
/// The protocol of a study as prostm study run presents it.

#include <string>

#include "options.hpp"
#include "prostm/study/task/protocol_file.hpp"

namespace prostm::app {

/// Returns the base settings of all methods: those of a run in real time whose jets follow the
/// palm.
/// @throws InputError as make_settings() does.
PipelineSettings study_settings(const CommonOptions& common);

/// Reads a protocol, with the planning time of a run in real time. @throws InputError as
/// read_protocol() does, and for a method that the device cannot play as it is written.
Protocol live_protocol(const std::string& path, const PipelineSettings& base);

}  // namespace prostm::app
