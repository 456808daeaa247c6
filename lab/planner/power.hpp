#pragma once
/// The power cost of more paths.

#include <vector>

#include "planner/contenders.hpp"
#include "prostm/acoustics/focus/focus_solver.hpp"
#include "prostm/emit/focus_sample.hpp"
#include "report.hpp"

namespace prostm::bench {

/// Returns the radiation pressure at each focal point when the array renders all of them at once,
/// by this method in 20 iterations, relative to one focal point alone at full drive.
/// @pre every intensity is in 0..1.
std::vector<double> reached(const TransducerArray& array, FocusMethod method,
                            const std::vector<FocusSample>& foci);

/// Plans the gallery with preset best and 1 to 8 paths, with a fixed amount of work per plan,
/// 200 mm above the USX-like array, full scale at the highest pressure of each plan. Prints for
/// each number of paths the quality, the power Σ I² that the plan asks for, the share left by
/// emission's default limit, and the radiation pressure that the array reaches at the focal points.
/// @param frames number of frames per field.
void measure_power(int frames, std::vector<Row>& rows);

}  // namespace prostm::bench
