#pragma once
/// A plan: paths or positions of focal points until the next plan comes.

#include <boost/container/static_vector.hpp>
#include <cmath>

#include "prostm/core/geometry.hpp"

namespace prostm {

inline constexpr int kMaxPaths = 8;        ///< focal points that a device can show at once
inline constexpr int kMaxPathPoints = 64;  ///< samples of one path

/// A closed focal-point path in a target's plane: the last point joins the first. Fixed capacity,
/// so that a plan is copied and handed between threads without touching the heap.
struct FocalPath {
  int patch = 0;  ///< index of the target patch (hand)
  boost::container::static_vector<Vec2, kMaxPathPoints> points;  ///< in P [m]
  /// Rendered p_i = γ p*, unit of the target; linear between points.
  boost::container::static_vector<double, kMaxPathPoints> pressure;
  double length = 0.0;  ///< length of the closed polygon of the points, in the plane [m]
  double speed = 0.0;   ///< speed of the focal point [m/s]
  /// Duration of a lap [s]: the length on the skin over the speed. The length on the skin is what
  /// is played; it is longer than `length` where the skin is uneven. Of a plan that an emission
  /// plays, take_played(), speed and period are those of its samples.
  double period = 0.0;
};

/// A focal point that stands still in a target's plane, its intensity modulated (AM).
struct FocalPoint {
  int patch = 0;                 ///< index of the target patch (hand)
  Vec2 position = Vec2::Zero();  ///< in P [m]
  double pressure = 0.0;         ///< rendered at the peak of the modulation, unit of the target
  double phase = 0.0;  ///< delay of its modulation, as a share of its period, 0 to 1, (B7)
};

using FocalPoints = boost::container::static_vector<FocalPoint, kMaxPaths>;

/// Shortest and longest loop of a plan in step [s].
inline constexpr double kShortestLoop = 1e-3, kLongestLoop = 1.0;
/// Whether a plan may have this loop [s]: 0, for none, or within these bounds.
inline bool is_loop(double loop) {
  return std::isfinite(loop) && (loop == 0.0 || (loop >= kShortestLoop && loop <= kLongestLoop));
}
/// Checks that. @throws std::invalid_argument with a sentence.
void require_loop(double loop);
/// Whether a focus may have this phase.
inline bool is_phase(double phase) {
  return std::isfinite(phase) && phase >= 0.0 && phase <= 1.0;
}

/// Either closed paths or foci; the other list is empty.
///
/// A plan with `loop` above 0 is in step: each path goes round in a whole number of laps while the
/// loop goes round once, and is at its first point when the loop begins, (E10). `speed` and
/// `period` of its paths are those that this takes.
struct Plan {
  boost::container::static_vector<FocalPath, kMaxPaths> paths;
  FocalPoints foci;
  double loop = 0.0;  ///< period in which all paths come round together [s]; 0: each on its own

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

}  // namespace prostm
