#pragma once
/// The paper's Fig. 2 as data: clusters, tours, paths and reconstruction, digitised from the
/// figure.

#include <string>
#include <string_view>
#include <vector>

#include "prostm/plan/planner.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm {

/// The content of the panels (b) to (f) of a digitised figure, for the target of its panel (a).
struct DigitisedFigure {
  PlanTrace trace;
  Plan plan;                           ///< the refined paths; pressure = γ p* at their points
  std::vector<double> reconstruction;  ///< in the target's unit, rows·cols of the target
};

/// Reads {"fig2": {"clusters_mm", "cluster_value_norm", "initial_tour_mm", "split_paths_mm",
/// "refined_paths_mm", "recon_norm"}}: points [x, y] in mm, closed tours with the first point
/// repeated at the end, values relative to the colour bar.
/// @param target the figure's panel (a), on the same raster. @throws InputError with a sentence.
DigitisedFigure digitised_figure_from_json(std::string_view text, const std::string& name,
                                           const TargetField& target, const GainLaw& gain,
                                           double speed);

}  // namespace prostm
