#pragma once
/// Pictures of a plan.

#include <string>

#include "prostm/emit/played.hpp"
#include "prostm/figure/figures.hpp"
#include "prostm/io/digitised_figure.hpp"
#include "prostm/pipeline/settings.hpp"

namespace prostm::app {

/// Returns the pressures of a plan as they are played.
SegmentPressures played(const TargetField& target, const Plan& plan,
                        const PipelineSettings& settings);

/// The panels of a plan, which refer to target, plan and trace; without metrics.
PlanFigure as_figure(const TargetField& target, const Plan& plan, const PlanTrace& trace,
                     const PipelineSettings& settings);
/// The panels of a digitised figure for the same target, with the metrics of its paths.
PlanFigure as_figure(const TargetField& target, const DigitisedFigure& digitised,
                     const PipelineSettings& settings, const std::string& title);

}  // namespace prostm::app
