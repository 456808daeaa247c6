#pragma once
/// What rounder paths cost.

#include <string>
#include <vector>

#include "prostm/plan/plan.hpp"
#include "report.hpp"

namespace prostm::bench {

/// How a path bends, its points joined by straight lines.
struct Bending {
  double sharpest = 0.0;  ///< largest |turn| at a point [rad]
  double rms = 0.0;       ///< root mean square of the turns [rad]
  double excess = 0.0;    ///< sum of |turn| less 2π, which is that of a convex path [rad]
};

/// @pre the path has three points or more, and no two that follow each other coincide.
Bending bending(const FocalPath& path);

/// Plans the gallery with preset best and its weights of bending 0 to 10, and with paper-valid and
/// its own, each with a fixed amount of work. Prints for each weight the means of RMSE and skill
/// over the fields, and of the turns and lengths over the paths; draws the trade to `figure` where
/// that is not empty. @throws InputError when it cannot be written.
void measure_bending(const std::string& figure, std::vector<Row>& rows);

}  // namespace prostm::bench
