#pragma once
/// What more paths cost in power.

#include <complex>
#include <vector>

#include "device/simulated_array.hpp"
#include "planner/contenders.hpp"
#include "report.hpp"

namespace prostm::bench {

/// Radiation pressures at focal points that an array renders at the same time, each over what the
/// array reaches there with one focal point alone at full drive.
struct Reached {
  std::vector<double> superposed;  ///< as the array superposes them, (A4)
  std::vector<double> full;        ///< with the same phases, every transducer at full drive
};

/// @pre every intensity is in 0..1.
Reached reached(const SimulatedArray& array, const std::vector<FocusSample>& foci);

/// Plans the gallery with preset best and 1 to 8 paths, a fixed amount of work each, 200 mm above
/// the simulated array, full scale at the highest pressure of each plan. Prints for each number of
/// paths quality, the power Σ I² that the plan asks for, the share that emission's default limit
/// leaves, and the radiation pressure that the array reaches at its focal points.
/// @param frames of each field.
void measure_power(int frames, std::vector<Row>& rows);

}  // namespace prostm::bench
