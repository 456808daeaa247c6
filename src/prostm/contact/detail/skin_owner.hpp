#pragma once
/// Assigns points on the skin to hands. Private to contact.

#include <array>
#include <span>

#include "prostm/hand/hand_shape.hpp"

namespace prostm {

/// Returns the hand with the smaller signed distance; ties go to the first. The reference for
/// SkinOwner. @pre one or two shapes.
int nearest_hand(std::span<const HandShape> shapes, const Vec3& p_D) noexcept;

/// Returns the same as nearest_hand(), mostly without computing a distance. A point farther from a
/// hand's bounds than from the skin belongs to the other hand. Distances are 1-Lipschitz, so all
/// points in a ball around a computed point have the same owner; the radius is half the difference
/// between the two distances there.
class SkinOwner {
 public:
  /// Sets the shapes and keeps a reference to them. @param near upper bound of the distance of
  /// every queried point outside the hands to the nearer skin [m]. @pre at most two shapes.
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
  std::array<Ball, 8> balls_;  // the most recent balls
  std::size_t next_ = 0;       // the ball to replace next
};

}  // namespace prostm
