#pragma once
/// A plan on the skin: paths and foci in 3-D.

#include <boost/container/static_vector.hpp>
#include <cstdint>

#include "prostm/core/geometry.hpp"
#include "prostm/plan/plan.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm {

inline constexpr int kLiftedPointsPerSegment = 5;
inline constexpr int kMaxLiftedPoints = kMaxPathPoints * kLiftedPointsPerSegment;

/// A closed 3-D polygon with arc length. Point i is at arc length s[i]; the closing edge ends at
/// `length`.
struct LiftedPath {
  boost::container::static_vector<Vec3, kMaxLiftedPoints> p_D;  ///< [m]
  /// Rendered pressure, unit of the target.
  boost::container::static_vector<double, kMaxLiftedPoints> pressure;
  boost::container::static_vector<double, kMaxLiftedPoints> s;  ///< [m], s[0] = 0
  double length = 0.0;                                          ///< length on the skin [m]
  double speed = 0.0;                                           ///< [m/s]
  int patch = 0;  ///< index of the target patch that it lies on
};

/// A focal point that stands still.
struct LiftedFocus {
  Vec3 p_D = Vec3::Zero();  ///< [m]
  double pressure = 0.0;    ///< rendered at the peak of the modulation, unit of the target
  int patch = 0;            ///< index of the target patch that it lies on
  double phase = 0.0;       ///< as FocalPoint::phase
};

/// Either paths or foci; the other list is empty.
struct LiftedPlan {
  boost::container::static_vector<LiftedPath, kMaxPaths> paths;
  boost::container::static_vector<LiftedFocus, kMaxPaths> foci;
  double loop = 0.0;    ///< as Plan::loop [s]
  std::int64_t id = 0;  ///< number of the plan, from 1
};

/// Undoes the projection of section IV-A: cuts each segment into kLiftedPointsPerSegment pieces and
/// gives each point the height of the skin there (height_at). `speed` applies along the 3-D curve.
/// The heights are smoothed along the path over two cells, (E1), since the steps of a raster would
/// make the curve longer than the skin is. A path of fewer than two distinct points becomes a point
/// at rest; a path without points is omitted. A focus gets the height of the skin there. Sets all
/// but `id`. @pre every `patch` is an index into frame.patches.
void lift(const Plan& plan, const TargetFrame& frame, LiftedPlan& out) noexcept;

/// Returns the length on the skin of one path over `field`, the same as that of lift() [m]. Does
/// not read its pressures.
double skin_length(const FocalPath& path, const TargetField& field) noexcept;

/// Computes `s` and `length` from the points. @pre coordinates are finite.
void measure(LiftedPath& path) noexcept;

/// Position and rendered pressure on a path at arc length s (taken modulo the length), linear
/// between points.
struct PathPoint {
  Vec3 p_D;
  double pressure;
};
/// Returns the place at s. @pre the path has a point and is measured; s is finite.
PathPoint point_at(const LiftedPath& path, double s);

/// The place on a path that is nearest to a point.
struct PathPlace {
  double s = 0.0;               ///< [m]
  double distance = 0.0;        ///< [m]
  Vec3 p_D = Vec3::Zero();      ///< [m]
  Vec3 tangent = Vec3::Zero();  ///< unit vector of growing s; zero for a point at rest
};
/// Finds the nearest place on the two edges at the nearest vertex. @pre the path has a point and is
/// measured.
PathPlace nearest_place(const LiftedPath& path, const Vec3& p_D);

}  // namespace prostm
