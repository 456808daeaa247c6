#include "prostm/contact/detail/skin_owner.hpp"

#include <cmath>

namespace prostm {
namespace {

constexpr double kRounding = 1e-9;  // margin, larger than the error of the distances [m]

/// Returns the squared distance to the bounds of a hand; 0 inside.
double outside_squared(const HandShape& shape, const Vec3& p) {
  return (shape.lower() - p).cwiseMax(p - shape.upper()).cwiseMax(0.0).squaredNorm();
}

}  // namespace

int nearest_hand(std::span<const HandShape> shapes, const Vec3& p_D) noexcept {
  if (shapes.size() == 1) return 0;
  return shapes[0].distance(p_D) <= shapes[1].distance(p_D) ? 0 : 1;
}

void SkinOwner::set(std::span<const HandShape> shapes, double near) noexcept {
  shapes_ = shapes;
  near_squared_ = near * near;
  balls_.fill(Ball{});
  next_ = 0;
}

int SkinOwner::of(const Vec3& p_D) noexcept {
  if (shapes_.size() == 1 || outside_squared(shapes_[1], p_D) > near_squared_) return 0;
  if (outside_squared(shapes_[0], p_D) > near_squared_) return 1;
  for (const Ball& ball : balls_) {
    if ((p_D - ball.centre).squaredNorm() < ball.radius_squared) return ball.hand;
  }
  return ask(p_D);
}

int SkinOwner::ask(const Vec3& p_D) noexcept {
  const double first = shapes_[0].distance(p_D), second = shapes_[1].distance(p_D);
  const int hand = first <= second ? 0 : 1;
  const double radius = 0.5 * std::abs(first - second) - kRounding;
  if (radius > 0.0) {
    balls_[next_] = {p_D, radius * radius, hand};
    next_ = (next_ + 1) % balls_.size();
  }
  return hand;
}

}  // namespace prostm
