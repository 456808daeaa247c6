#pragma once
/// The surface of a hand: round cones along the bones and sphere-triangles across the palm.

#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <span>

#include "prostm/core/geometry.hpp"
#include "prostm/hand/detail/primitives.hpp"
#include "prostm/track/hand_frame.hpp"

namespace prostm {

/// Region of a hand's skin: last phalanges (Tip), other phalanges (Finger), all else (Palm).
enum class SkinRegion : std::uint8_t { Palm, Finger, Tip };

/// Signed distance, normal and velocity of the skin of one hand, in the frame of the hand it was
/// made from (D in the pipeline). The union (minimum) of round cones along the phalanges and of
/// sphere-triangles that span the palm, the ball of the thumb and the wrist. Distances are exact
/// outside and at the skin; inside, where bodies overlap, they are those of the deepest body, never
/// deeper than the truth.
class HandShape {
 public:
  HandShape() = default;
  explicit HandShape(const Hand& hand) { set(hand); }
  /// Builds the surface. Trackers report the thickness of fingers well, but a palm as thin as
  /// fingers. So each radius in the palm has a lower bound, a fraction of the palm joint's radius,
  /// (H12) of docs/design/hands.md.
  void set(const Hand& hand) noexcept;

  SurfacePoint query(const Vec3& p) const noexcept;
  double distance(const Vec3& p) const noexcept;
  /// Returns the region of the body nearest to p; of equally near bodies, the first one.
  SkinRegion region(const Vec3& p) const noexcept;

  /// Axis-aligned bounds of the skin [m].
  Vec3 lower() const { return lower_; }
  Vec3 upper() const { return upper_; }

  std::span<const RoundCone> cones() const { return {cones_.data(), cones_.size()}; }
  std::span<const SphereTriangle> triangles() const {
    return {triangles_.data(), triangles_.size()};
  }

  static constexpr std::size_t kMaxCones = 14, kMaxTriangles = 10;

 private:
  void add(const CornerSphere& a, const CornerSphere& b) noexcept;
  void add(const CornerSphere& a, const CornerSphere& b, const CornerSphere& c) noexcept;

  boost::container::static_vector<RoundCone, kMaxCones> cones_;
  boost::container::static_vector<SphereTriangle, kMaxTriangles> triangles_;
  Vec3 lower_ = Vec3::Zero(), upper_ = Vec3::Zero();
};

}  // namespace prostm
