#pragma once
/// Distances between the focal points of a plan at the same time.

#include <cstddef>
#include <span>
#include <vector>

#include "prostm/core/random.hpp"
#include "prostm/plan/plan.hpp"
#include "report.hpp"

namespace prostm::bench {

/// One wavelength at 40 kHz [m]: an array cannot separate two foci nearer than this.
inline constexpr double kWavelength = 8.6e-3;

/// The least distance between any two audible focal points, instant by instant.
class LeastDistances {
 public:
  /// Adds an instant. @param sounding places of the audible focal points [m]; fewer than two add
  /// nothing.
  void add(std::span<const Vec3> sounding);
  void add(const LeastDistances& other);

  std::size_t instants() const { return least_.size(); }
  double share_below(double distance) const;  ///< share of the instants
  /// Returns a quantile by the nearest-rank rule [m]; 0 without instants.
  double quantile(double share) const;
  double least() const { return quantile(0.0); }

 private:
  std::vector<double> least_;  // [m]
};

/// Returns the path begun at point `first`, in the other direction if `reversed`.
FocalPath begun_at(const FocalPath& path, int first, bool reversed);

/// Returns the plan with every path begun at a random point, and, if `senses`, in a random
/// direction.
Plan begun_anywhere(const Plan& plan, Random& random, bool senses);

/// Follows the plan's focal points from the paths' first points on for `seconds`, each in its own
/// period. A focal point is audible where the path's pressure is at least `silent_below`.
void follow(const Plan& plan, double seconds, double silent_below, LeastDistances& out);

/// Prints the share of time in which any two audible focal points are nearer than one and than two
/// wavelengths, and the least and the 5 % distance, over plans of the generated fields: for the
/// starts as planned, for random starts, and for random starts and directions. Prints the same for
/// consecutive plans emitted from silence on.
/// @param frames number of frames per pattern.
void measure_simultaneous(int frames, std::vector<Row>& rows);

}  // namespace prostm::bench
