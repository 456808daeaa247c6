#include "prostm/hand/hand_shape.hpp"

#include <algorithm>
#include <array>

namespace prostm {
namespace {

// least radii in the palm as shares of the palm's own radius (H12)
constexpr double kFleshAtMetacarpal = 0.85;  // base of the metacarpals
constexpr double kFleshAtKnuckle = 0.80;     // seen from the palm
constexpr double kFleshAtThumbRoot = 0.95;   // ball of the thumb
constexpr double kFleshAtThumbKnuckle = 0.75;
constexpr double kFleshOfWeb = 0.60;  // skin between thumb and index finger
constexpr double kWebReach = 0.65;    // share of the index metacarpal where it joins

CornerSphere corner(const Hand& hand, int joint, double least_radius = 0.0) {
  const auto j = static_cast<std::size_t>(joint);
  return {hand.position[j], std::max(hand.radius[j], least_radius), hand.velocity[j]};
}

CornerSphere between(const CornerSphere& a, const CornerSphere& b, double u, double radius) {
  return {a.centre + u * (b.centre - a.centre), radius, a.velocity + u * (b.velocity - a.velocity)};
}

/// Region of each cone, in the order in which set() adds them; triangles belong to the palm.
constexpr std::array<SkinRegion, HandShape::kMaxCones> kConeRegions = [] {
  std::array<SkinRegion, HandShape::kMaxCones> regions{};
  regions.fill(SkinRegion::Finger);
  for (std::size_t finger = 0; finger < 4; ++finger) regions[3 * finger + 2] = SkinRegion::Tip;
  regions.back() = SkinRegion::Tip;  // the thumb's
  return regions;
}();

/// Lowers `nearest` to the body's distance where that is less. @return whether it is.
template <class Body>
bool take_nearer(const Body& body, const Vec3& p, double& nearest) noexcept {
  // a body is no nearer than its bounds
  const double outside = (body.lower() - p).cwiseMax(p - body.upper()).cwiseMax(0.0).squaredNorm();
  if (outside > std::max(nearest, 0.0) * nearest) return false;
  const double distance = body.distance(p);
  if (distance >= nearest) return false;
  nearest = distance;
  return true;
}

}  // namespace

void HandShape::add(const CornerSphere& a, const CornerSphere& b) noexcept {
  cones_.emplace_back(a, b);
  lower_ = lower_.cwiseMin(cones_.back().lower());
  upper_ = upper_.cwiseMax(cones_.back().upper());
}

void HandShape::add(const CornerSphere& a, const CornerSphere& b, const CornerSphere& c) noexcept {
  triangles_.emplace_back(a, b, c);
  lower_ = lower_.cwiseMin(triangles_.back().lower());
  upper_ = upper_.cwiseMax(triangles_.back().upper());
}

void HandShape::set(const Hand& hand) noexcept {
  cones_.clear();
  triangles_.clear();
  lower_ = upper_ = hand.position[kPalm];

  // phalanges
  for (const int knuckle : {kIndexProximal, kMiddleProximal, kRingProximal, kLittleProximal}) {
    for (int j = knuckle; j < knuckle + 3; ++j) add(corner(hand, j), corner(hand, j + 1));
  }
  add(corner(hand, kThumbProximal), corner(hand, kThumbDistal));
  add(corner(hand, kThumbDistal), corner(hand, kThumbTip));

  // palm: a band of two triangles from each metacarpal to the next
  const double palm = hand.radius[kPalm];
  const CornerSphere base[4] = {corner(hand, kIndexMetacarpal, kFleshAtMetacarpal * palm),
                                corner(hand, kMiddleMetacarpal, kFleshAtMetacarpal * palm),
                                corner(hand, kRingMetacarpal, kFleshAtMetacarpal * palm),
                                corner(hand, kLittleMetacarpal, kFleshAtMetacarpal * palm)};
  const CornerSphere knuckle[4] = {corner(hand, kIndexProximal, kFleshAtKnuckle * palm),
                                   corner(hand, kMiddleProximal, kFleshAtKnuckle * palm),
                                   corner(hand, kRingProximal, kFleshAtKnuckle * palm),
                                   corner(hand, kLittleProximal, kFleshAtKnuckle * palm)};
  for (std::size_t f = 0; f < 3; ++f) {
    add(base[f], base[f + 1], knuckle[f]);
    add(knuckle[f], base[f + 1], knuckle[f + 1]);
  }

  // ball of the thumb, the web beside it, and the wrist
  const CornerSphere thumb_root = corner(hand, kThumbMetacarpal, kFleshAtThumbRoot * palm);
  const CornerSphere thumb_knuckle = corner(hand, kThumbProximal, kFleshAtThumbKnuckle * palm);
  const CornerSphere wrist = corner(hand, kWrist);
  add(thumb_root, thumb_knuckle, base[0]);
  add(thumb_knuckle, base[0], between(base[0], knuckle[0], kWebReach, kFleshOfWeb * palm));
  add(wrist, base[0], base[3]);
  add(wrist, thumb_root, base[0]);
}

double HandShape::distance(const Vec3& p) const noexcept {
  double nearest = 1e30;
  for (const RoundCone& cone : cones_) take_nearer(cone, p, nearest);
  for (const SphereTriangle& triangle : triangles_) take_nearer(triangle, p, nearest);
  return nearest;
}

SkinRegion HandShape::region(const Vec3& p) const noexcept {
  double nearest = 1e30;
  SkinRegion region = SkinRegion::Palm;
  for (std::size_t n = 0; n < cones_.size(); ++n) {
    if (take_nearer(cones_[n], p, nearest)) region = kConeRegions[n];
  }
  for (const SphereTriangle& triangle : triangles_) {
    if (take_nearer(triangle, p, nearest)) region = SkinRegion::Palm;
  }
  return region;
}

SurfacePoint HandShape::query(const Vec3& p) const noexcept {
  SurfacePoint nearest;
  nearest.distance = 1e30;
  const auto take = [&](const SurfacePoint& point) {
    if (point.distance < nearest.distance) nearest = point;
  };
  for (const RoundCone& cone : cones_) take(cone.query(p));
  for (const SphereTriangle& triangle : triangles_) take(triangle.query(p));
  return nearest;
}

}  // namespace prostm
