#pragma once
/// A run's settings as the text of a settings file. Private to viewer.

#include <string>

#include "prostm/pipeline/settings.hpp"

namespace prostm::viewer {

/// Every setting that differs from its default, as TOML for `--settings`; empty if none does. A
/// time budget that a run in real time sets itself is left out.
std::string changed_settings(PipelineSettings settings);

}  // namespace prostm::viewer
