#pragma once
/// The picture of one instant of a run.

#include <string>

#include "prostm/pipeline/pipeline.hpp"

namespace prostm::app {

/// Draws the scene from the side, the targets and their plans. @pre the run had
/// settings.side_view, and the instant a hand under pressure. @throws InputError if the file
/// cannot be written.
void draw_instant(const WorldFrame& contact, const PlanFrame& planned,
                  const PipelineSettings& settings, const std::string& path);

}  // namespace prostm::app
