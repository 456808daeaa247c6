#pragma once
/// Whose skin a point is on. Private to contact.

#include <array>
#include <span>

#include "prostm/hand/hand_shape.hpp"

namespace prostm {

/// The plain way, the reference for SkinOwner: the hand whose signed distance is the smaller one,
/// the first of equals. @pre one or two shapes.
int nearest_hand(std::span<const HandShape> shapes, const Vec3& p_D) noexcept;

/// The same answer, mostly without asking for a distance: a point farther from a hand's bounds than
/// from the skin is the other hand's, and a distance changes at most as fast as the point moves, so
/// that in a ball around a point that was asked, of half the difference between the two distances
/// there, all points have the same owner.
class SkinOwner {
 public:
  /// Refers to `shapes` from here on. @param near every point that is asked is at most this far
  /// from the nearer skin, or inside a hand [m]. @pre at most two shapes.
  void set(std::span<const HandShape> shapes, double near) noexcept;
  /// The hand of a point. @pre at least one shape.
  int of(const Vec3& p_D) noexcept;

 private:
  struct Ball {
    Vec3 centre = Vec3::Zero();
    double radius_squared = 0.0;  // 0: of no use
    int hand = 0;
  };
  int ask(const Vec3& p_D) noexcept;

  std::span<const HandShape> shapes_;
  double near_squared_ = 0.0;
  std::array<Ball, 8> balls_;  // the latest
  std::size_t next_ = 0;       // to be replaced
};

}  // namespace prostm
