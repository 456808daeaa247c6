#pragma once
/// The hand on whose skin a point lies. Private to contact.

#include <array>
#include <span>

#include "prostm/hand/hand_shape.hpp"

namespace prostm {

/// Returns the hand with the smaller signed distance, the first of equals; the reference for
/// SkinOwner. @pre one or two shapes.
int nearest_hand(std::span<const HandShape> shapes, const Vec3& p_D) noexcept;

/// Gives the same answer, mostly without computing a distance. A point farther from a hand's bounds
/// than from the skin belongs to the other hand. A distance changes at most as fast as the point
/// moves. So all points in a ball around a computed one have its owner; the radius is half the
/// difference between the two distances there.
class SkinOwner {
 public:
  /// Refers to `shapes` from now on. @param near every queried point is at most this far from the
  /// nearer skin, or inside a hand [m]. @pre at most two shapes.
  void set(std::span<const HandShape> shapes, double near) noexcept;
  /// Returns the hand of a point. @pre at least one shape.
  int of(const Vec3& p_D) noexcept;

 private:
  struct Ball {
    Vec3 centre = Vec3::Zero();
    double radius_squared = 0.0;  // 0: unused
    int hand = 0;
  };
  int ask(const Vec3& p_D) noexcept;

  std::span<const HandShape> shapes_;
  double near_squared_ = 0.0;
  std::array<Ball, 8> balls_;  // the latest ones
  std::size_t next_ = 0;       // the next to be replaced
};

}  // namespace prostm
