#pragma once
/// Protocols as files hold them: TOML to read, JSON in participants' files.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "prostm/study/protocol/protocol.hpp"
#include "prostm/study/task/tasks.hpp"

namespace prostm {

/// Reads a protocol (docs/study/study.md). @param base the settings that methods begin with. @param
/// tasks those that it may name; the first is the default. They outlive the protocol.
/// @throws InputError with file and line: no TOML, a table or key that is unknown, a value that is
/// out of bounds; no method, too few scenes, a scene that does not exist, no question; levels that
/// are missing, are not for this task, or do not suit their setting.
Protocol protocol_from_toml(std::string_view text, const std::string& file,
                            const PipelineSettings& base, Tasks tasks = study_tasks());
Protocol read_protocol(const std::string& path, const PipelineSettings& base,
                       Tasks tasks = study_tasks());

/// All of it, the settings of each method included.
nlohmann::ordered_json protocol_json(const Protocol& protocol);

}  // namespace prostm
