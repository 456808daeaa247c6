#pragma once
/// How near the focal points of a plan come to each other at the same time.

#include <cstddef>
#include <span>
#include <vector>

#include "prostm/core/random.hpp"
#include "prostm/plan/plan.hpp"
#include "report.hpp"

namespace prostm::bench {

/// One wavelength of 40 kHz [m]: an array cannot show two nearer foci as two.
inline constexpr double kWavelength = 8.6e-3;

/// The least distance of any two sounding focal points, instant by instant.
class LeastDistances {
 public:
  /// Adds an instant. @param sounding where those are that sound [m]; of fewer than two nothing is
  /// added.
  void add(std::span<const Vec3> sounding);
  void add(const LeastDistances& other);

  std::size_t instants() const { return least_.size(); }
  double share_below(double distance) const;  ///< of the instants
  /// By the nearest-rank rule [m]; 0 when there is no instant.
  double quantile(double share) const;
  double least() const { return quantile(0.0); }

 private:
  std::vector<double> least_;  // [m]
};

/// The path begun at point `first`, the other way round if `reversed`.
FocalPath begun_at(const FocalPath& path, int first, bool reversed);

/// The plan with every path begun at a random point; the other way round as often as not, if
/// `senses`.
Plan begun_anywhere(const Plan& plan, Random& random, bool senses);

/// Follows the plan's focal points from the paths' first points on for `seconds`, each in its own
/// period. A focal point sounds where the path's pressure is at least `silent_below`.
void follow(const Plan& plan, double seconds, double silent_below, LeastDistances& out);

/// Prints the share of time in which any two sounding focal points are nearer than one and than two
/// wavelengths, and the least and the 5 % distance, over plans of the generated fields: for the
/// starts as planned, for random starts, and for random starts and senses; and the same in the
/// emission of plans that continue, from silence on.
/// @param frames of each pattern's sequence.
void measure_simultaneous(int frames, std::vector<Row>& rows);

}  // namespace prostm::bench
