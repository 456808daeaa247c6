#pragma once
/// A plan: paths or positions of focal points, valid until the next plan.

#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <cmath>

#include "prostm/core/geometry.hpp"

namespace prostm {

inline constexpr int kMaxPaths = 8;        ///< maximum number of simultaneous focal points
inline constexpr int kMaxPathPoints = 64;  ///< samples of one path

/// A closed focal-point path in a target's plane: the last point joins the first. The capacity is
/// fixed, so that copying a plan and passing it between threads does not allocate.
struct FocalPath {
  int patch = 0;  ///< index of the target patch (hand)
  boost::container::static_vector<Vec2, kMaxPathPoints> points;  ///< in P [m]
  /// Rendered p_i = γ p*, unit of the target; linear between points.
  boost::container::static_vector<double, kMaxPathPoints> pressure;
  double length = 0.0;  ///< length of the closed polygon of the points, in the plane [m]
  double speed = 0.0;   ///< speed of the focal point [m/s]
  /// Duration of a lap [s]: the length on the skin over the speed. The focal point covers the
  /// length on the skin, which exceeds `length` where the skin is uneven. In a plan being emitted,
  /// see take_played(), speed and period are those of the samples.
  double period = 0.0;
};

/// A stationary focal point in a target's plane with amplitude modulation (AM).
struct FocalPoint {
  int patch = 0;                 ///< index of the target patch (hand)
  Vec2 position = Vec2::Zero();  ///< in P [m]
  double pressure = 0.0;         ///< rendered at the peak of the modulation, unit of the target
  double phase = 0.0;  ///< delay of the modulation, as a share of the period, 0 to 1, (B7)
};

using FocalPoints = boost::container::static_vector<FocalPoint, kMaxPaths>;

/// Shortest and longest loop of a plan in step [s].
inline constexpr double kShortestLoop = 1e-3, kLongestLoop = 1.0;
/// Returns whether `loop` is a valid Plan::loop [s]: 0, for none, or within these bounds.
inline bool is_loop(double loop) {
  return std::isfinite(loop) && (loop == 0.0 || (loop >= kShortestLoop && loop <= kLongestLoop));
}
/// Checks is_loop(loop). @throws std::invalid_argument if it is false.
void require_loop(double loop);
/// Returns whether `phase` is a valid FocalPoint::phase.
inline bool is_phase(double phase) {
  return std::isfinite(phase) && phase >= 0.0 && phase <= 1.0;
}

/// Either closed paths or foci; the other list is empty.
///
/// A plan with `loop` above 0 is in step: each path makes a whole number of laps per loop, and is
/// at its first point when the loop begins, (E10). `speed` and `period` of its paths are set
/// accordingly.
struct Plan {
  boost::container::static_vector<FocalPath, kMaxPaths> paths;
  FocalPoints foci;
  double loop = 0.0;  ///< common period of all paths [s]; 0: each path has its own period

  bool empty() const { return paths.empty() && foci.empty(); }
  void clear() {
    paths.clear();
    foci.clear();
    loop = 0.0;
  }
};

/// Length of the closed polygon [m].
double closed_length(const FocalPath& path);

/// Moves every path and focus by `shift` in the plane [m].
void translate(Plan& plan, const Vec2& shift);

/// Returns the largest pressure of the paths and foci of a Plan or LiftedPlan; 0 without any.
template <class AnyPlan>
double largest_pressure(const AnyPlan& plan) {
  double largest = 0.0;
  for (const auto& path : plan.paths) {
    for (const double p : path.pressure) largest = std::max(largest, p);
  }
  for (const auto& focus : plan.foci) largest = std::max(largest, focus.pressure);
  return largest;
}

}  // namespace prostm
