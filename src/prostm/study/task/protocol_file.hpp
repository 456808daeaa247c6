#pragma once
/// Protocols in files: read from TOML, written as JSON in participants' files.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "prostm/study/protocol/protocol.hpp"
#include "prostm/study/task/tasks.hpp"

namespace prostm {

/// Reads a protocol (docs/study/study.md). @param base settings that methods start from. @param
/// tasks the known tasks, of which the first is the default; they must outlive the protocol.
/// @throws InputError with file and line: invalid TOML, an unknown table or key, a value out of
/// bounds; no method, too few scenes, an unknown scene, no question; levels that are missing, not
/// used by this task, or invalid for their setting.
Protocol protocol_from_toml(std::string_view text, const std::string& file,
                            const PipelineSettings& base, Tasks tasks = study_tasks());
Protocol read_protocol(const std::string& path, const PipelineSettings& base,
                       Tasks tasks = study_tasks());

/// The whole protocol, including the settings of each method.
nlohmann::ordered_json protocol_json(const Protocol& protocol);

}  // namespace prostm
