#pragma once
/// Compares the ways to render a target.

#include <string>
#include <vector>

#include "methods/rendering.hpp"
#include "report.hpp"

namespace prostm::bench {

/// The quantity that is made equal between ways before they are compared.
enum class Equal { Drive, Power, Percept };

/// Returns the factor for the square of a way's drives. Drive: the largest |q| becomes 1; Power: Σ
/// |q|² becomes the reference's; Percept: the largest percept becomes the reference's. 0 if the way
/// has no drives to scale.
double factor_for(Equal equal, const Rendering& rendering, const Rendering& reference);

/// Targets of one raster, 200 mm or so above the array.
using Targets = std::vector<TargetField>;
/// Returns so many frames of each generated sequence.
Targets generated_targets(int frames);
/// Returns so many frames of a recording's second half, when jets have settled on a still hand: the
/// first patch of each. @throws InputError where a frame has no pressure, or another raster.
Targets recorded_targets(const std::string& path, int frames);

/// Renders targets in every way with the USX-like array, and prints means: first the quantities
/// that no factor changes, then pressures and percepts under each control.
void compare_ways(const Targets& targets, std::vector<Row>& rows);

/// Draws the target, and for each way the envelope and the percept, for two generated fields.
void draw_ways(const std::string& path);

}  // namespace prostm::bench
