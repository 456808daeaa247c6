#pragma once
/// What more paths cost in power.

#include <vector>

#include "planner/contenders.hpp"
#include "prostm/acoustics/focus_solver.hpp"
#include "prostm/emit/focus_sample.hpp"
#include "report.hpp"

namespace prostm::bench {

/// Radiation pressure at each focal point that the array renders at the same time with the others,
/// by this method in 20 iterations, over what it has there with one focal point alone at full
/// drive.
/// @pre every intensity is in 0..1.
std::vector<double> reached(const TransducerArray& array, FocusMethod method,
                            const std::vector<FocusSample>& foci);

/// Plans the gallery with preset best and 1 to 8 paths, a fixed amount of work each, 200 mm above
/// the USX-like array, full scale at the highest pressure of each plan. Prints for each number of
/// paths quality, the power Σ I² that the plan asks for, the share that emission's default limit
/// leaves, and the radiation pressure that the array reaches at its focal points.
/// @param frames of each field.
void measure_power(int frames, std::vector<Row>& rows);

}  // namespace prostm::bench
