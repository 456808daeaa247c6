#pragma once
/// The cost of rounder paths.

#include <string>
#include <vector>

#include "prostm/plan/plan.hpp"
#include "report.hpp"

namespace prostm::bench {

/// Turns of a path whose points are joined by straight lines.
struct Bending {
  double sharpest = 0.0;  ///< largest |turn| at a point [rad]
  double rms = 0.0;       ///< root mean square of the turns [rad]
  double excess = 0.0;    ///< sum of |turn| minus 2π, the sum of a convex path [rad]
};

/// @pre the path has at least three points, and no two consecutive points coincide.
Bending bending(const FocalPath& path);

/// Plans the gallery with a fixed amount of work per plan for weights of bending from 0 to 10, with
/// preset best and with paper-valid, each with its own setting. Prints for each weight the means of
/// RMSE and skill over the fields, and of turns and lengths over the paths. Draws the trade-off to
/// `figure` unless it is empty. @throws InputError if it cannot be written.
void measure_bending(const std::string& figure, std::vector<Row>& rows);

}  // namespace prostm::bench
