#pragma once
/// The two bodies that a hand is made of. Each is the convex hull of its corner spheres: seen from
/// a point, its skin is that of one sphere whose centre, radius and velocity are blended from the
/// corners. (H8) to (H11) of docs/design/hands.md.

#include <array>

#include "prostm/core/geometry.hpp"
#include "prostm/hand/detail/packed_body.hpp"

namespace prostm {

struct SurfacePoint {
  double distance = 0.0;         ///< signed, negative inside [m]
  Vec3 normal = Vec3::UnitZ();   ///< outward, unit
  Vec3 velocity = Vec3::Zero();  ///< velocity of the nearest skin point [m/s]
};

/// A corner of a body: a sphere that moves.
struct CornerSphere {
  Vec3 centre = Vec3::Zero();    ///< [m]
  double radius = 0.0;           ///< [m], > 0
  Vec3 velocity = Vec3::Zero();  ///< [m/s]
};

/// The hull of two spheres. If one sphere contains the other, it is the larger sphere.
class RoundCone {
 public:
  RoundCone() = default;
  RoundCone(const CornerSphere& a, const CornerSphere& b) noexcept;

  double distance(const Vec3& p) const noexcept;
  SurfacePoint query(const Vec3& p) const noexcept;
  PackedCone packed(const Vec3& origin) const noexcept;
  const Vec3& lower() const { return lower_; }  ///< corners of the bounding box [m]
  const Vec3& upper() const { return upper_; }

 private:
  /// Position of p along the cone's generator, from 0 at a to 1 at b, clamped.
  double blend(double along, double across) const noexcept;

  CornerSphere a_, b_;
  Vec3 axis_ = Vec3::Zero();  // unit, from a to b; zero for a sphere
  double sine_ = 0.0;         // (r_a − r_b) / |b − a|, sine of the angle from axis to generator
  double cosine_ = 1.0;
  double generator_ = 0.0;  // length of the tangent line from sphere to sphere [m]
  Vec3 lower_ = Vec3::Zero(), upper_ = Vec3::Zero();
};

/// The hull of three spheres: three round cones, and two faces where a plane touches all three
/// spheres.
class SphereTriangle {
 public:
  SphereTriangle() = default;
  SphereTriangle(const CornerSphere& a, const CornerSphere& b, const CornerSphere& c) noexcept;

  double distance(const Vec3& p) const noexcept;
  SurfacePoint query(const Vec3& p) const noexcept;
  /// A triangle too thin for single precision, thinner than 10⁻⁴ of its edges, is packed as its
  /// edges.
  PackedTriangle packed(const Vec3& origin) const noexcept;
  const Vec3& lower() const { return lower_; }  ///< corners of the bounding box [m]
  const Vec3& upper() const { return upper_; }

 private:
  /// One of the two planes that touch the three spheres, and the projection of points onto the
  /// triangle.
  struct Face {
    Vec3 normal = Vec3::Zero();
    Vec3 weight_b = Vec3::Zero(), weight_c = Vec3::Zero();  // barycentric weight = (p − a) · weight
  };
  struct Foot {
    double distance, b, c;  // distance to the face, and barycentric weights
    bool inside() const { return b >= 0.0 && c >= 0.0 && b + c <= 1.0; }
  };
  Foot foot(const Vec3& p) const noexcept;
  /// The edges that can hold the nearest point when it is not on a face: bit e for edge e.
  unsigned candidate_edges(const Foot& foot) const noexcept;

  CornerSphere a_, b_, c_;
  std::array<RoundCone, 3> edges_;  // bc, ca, ab
  std::array<Face, 2> faces_;       // on the side of plane_normal_, and on the other
  Vec3 plane_normal_ = Vec3::Zero();
  // false: the corners are in line, or a corner is hidden in the hull of the others
  bool has_faces_ = false;
  Vec3 lower_ = Vec3::Zero(), upper_ = Vec3::Zero();
};

}  // namespace prostm
