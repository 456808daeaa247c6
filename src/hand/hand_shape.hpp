#pragma once
/// The surface of a hand: round cones along the bones and sphere-triangles across the palm.

#include <array>
#include <boost/container/static_vector.hpp>

#include "core/geometry.hpp"
#include "track/hand_frame.hpp"

namespace prostm {

struct SurfacePoint {
  double distance = 0.0;             ///< signed, negative inside [m]
  Vec3 normal = Vec3::UnitZ();       ///< outward, unit
  Vec3 velocity = Vec3::Zero();      ///< of the nearest skin point [m/s]
};

/// Signed distance, normal and velocity of the skin of one hand, in the frame of the hand it was made from (D in the
/// pipeline). The union (minimum) of round cones between consecutive joints and sphere-triangles that span the palm.
class HandShape {
 public:
  HandShape() = default;
  explicit HandShape(const Hand& hand) { set(hand); }
  void set(const Hand& hand) noexcept;

  SurfacePoint query(const Vec3& p) const noexcept;
  double distance(const Vec3& p) const noexcept;

  /// Axis-aligned bounds of the skin [m].
  Vec3 lower() const { return lower_; }
  Vec3 upper() const { return upper_; }

 private:
  struct RoundCone { Vec3 a, b, va, vb; double ra = 0, rb = 0; };
  struct SphereTriangle { Vec3 a, b, c, va, vb, vc; double ra = 0, rb = 0, rc = 0; };
  boost::container::static_vector<RoundCone, 32> cones_;
  boost::container::static_vector<SphereTriangle, 16> triangles_;
  Vec3 lower_ = Vec3::Zero(), upper_ = Vec3::Zero();
};

}  // namespace prostm
