#include "prostm/hand/detail/primitives.hpp"

#include <algorithm>
#include <cmath>

namespace prostm {
namespace {

/// Returns the surface point for p on a sphere; `fallback` is the normal if p is the sphere's
/// centre.
SurfacePoint seen_from(const Vec3& p, const Vec3& centre, double radius, const Vec3& velocity,
                       const Vec3& fallback) {
  const Vec3 offset = p - centre;
  const double length = offset.norm();
  constexpr double kAtCentre = 1e-12;  // [m]
  return {length - radius, length > kAtCentre ? Vec3(offset / length) : fallback, velocity};
}

Vec3 any_perpendicular(const Vec3& axis) {
  int smallest = 0;
  axis.cwiseAbs().minCoeff(&smallest);
  return axis.cross(Vec3::Unit(smallest)).normalized();
}

void pack(const Vec3& v, float (&out)[3]) {
  for (int i = 0; i < 3; ++i) out[i] = static_cast<float>(v[i]);
}

}  // namespace

RoundCone::RoundCone(const CornerSphere& a, const CornerSphere& b) noexcept : a_(a), b_(b) {
  const Vec3 along = b.centre - a.centre;
  const double length = along.norm(), difference = a.radius - b.radius;
  const double generator_squared = length * length - difference * difference;
  constexpr double kShortest = 1e-6;  // with a shorter generator it is a sphere [m]
  if (generator_squared > kShortest * kShortest) {
    axis_ = along / length;
    generator_ = std::sqrt(generator_squared);
    sine_ = difference / length;
    cosine_ = generator_ / length;
  } else if (difference < 0.0) {
    a_ = b;
  }
  lower_ = (a_.centre.array() - a_.radius).matrix();
  upper_ = (a_.centre.array() + a_.radius).matrix();
  if (generator_ > 0.0) {
    lower_ = lower_.cwiseMin((b.centre.array() - b.radius).matrix());
    upper_ = upper_.cwiseMax((b.centre.array() + b.radius).matrix());
  }
}

double RoundCone::blend(double along, double across) const noexcept {
  const double k = cosine_ * along - sine_ * across;
  return k <= 0.0 ? 0.0 : k >= generator_ ? 1.0 : k / generator_;
}

double RoundCone::distance(const Vec3& p) const noexcept {
  const Vec3 d = p - a_.centre;
  const double along = d.dot(axis_);
  const double across = (d - along * axis_).norm();
  const double k = cosine_ * along - sine_ * across;
  if (k > 0.0 && k < generator_) return cosine_ * across + sine_ * along - a_.radius;
  if (k <= 0.0 || generator_ == 0.0) return d.norm() - a_.radius;
  return (p - b_.centre).norm() - b_.radius;
}

SurfacePoint RoundCone::query(const Vec3& p) const noexcept {
  if (generator_ == 0.0) return seen_from(p, a_.centre, a_.radius, a_.velocity, Vec3::UnitZ());
  const Vec3 d = p - a_.centre;
  const double along = d.dot(axis_);
  const double u = blend(along, (d - along * axis_).norm());
  const Vec3 on_axis = cosine_ * any_perpendicular(axis_) + sine_ * axis_;
  return seen_from(p, a_.centre + u * (b_.centre - a_.centre),
                   a_.radius + u * (b_.radius - a_.radius),
                   a_.velocity + u * (b_.velocity - a_.velocity), on_axis);
}

PackedCone RoundCone::packed(const Vec3& origin) const noexcept {
  PackedCone out{};
  pack(a_.centre - origin, out.centre);
  pack(a_.velocity, out.velocity);
  out.radius = static_cast<float>(a_.radius);
  out.cosine = 1.0F;
  if (generator_ == 0.0) return out;
  pack(axis_, out.axis);
  out.sine = static_cast<float>(sine_);
  out.cosine = static_cast<float>(cosine_);
  out.per_generator = static_cast<float>(1.0 / generator_);
  out.length = static_cast<float>((b_.centre - a_.centre).norm());
  out.growth = static_cast<float>(b_.radius - a_.radius);
  pack(b_.velocity - a_.velocity, out.change);
  return out;
}

SphereTriangle::SphereTriangle(const CornerSphere& a, const CornerSphere& b,
                               const CornerSphere& c) noexcept
    : a_(a), b_(b), c_(c), edges_{RoundCone(b, c), RoundCone(c, a), RoundCone(a, b)} {
  lower_ = edges_[0].lower().cwiseMin(edges_[1].lower()).cwiseMin(edges_[2].lower());
  upper_ = edges_[0].upper().cwiseMax(edges_[1].upper()).cwiseMax(edges_[2].upper());

  // the dual basis of the edges from a turns offsets in the plane into barycentric weights
  const Vec3 e1 = b.centre - a.centre, e2 = c.centre - a.centre, area = e1.cross(e2);
  const double area_squared = area.squaredNorm();
  constexpr double kThinnest = 1e-12;  // squared sine of the angle between two edges
  if (!(area_squared > kThinnest * e1.squaredNorm() * e2.squaredNorm())) return;
  plane_normal_ = area / std::sqrt(area_squared);
  const Vec3 dual_b = e2.cross(area) / area_squared, dual_c = area.cross(e1) / area_squared;

  // (H10): the normal n of a touching plane has n·(b − a) = r_a − r_b and n·(c − a) = r_a − r_c
  const Vec3 in_plane = (a.radius - b.radius) * dual_b + (a.radius - c.radius) * dual_c;
  const double rest = 1.0 - in_plane.squaredNorm();
  constexpr double kSteepest = 1e-9;
  if (rest < kSteepest) return;
  has_faces_ = true;
  for (std::size_t side = 0; side < 2; ++side) {
    const double height = side == 0 ? std::sqrt(rest) : -std::sqrt(rest);
    Face& face = faces_[side];
    face.normal = in_plane + height * plane_normal_;
    // p projects onto the plane along the normal: its weights are those of p − ((p − a)·N / n·N) n
    face.weight_b = dual_b - (face.normal.dot(dual_b) / height) * plane_normal_;
    face.weight_c = dual_c - (face.normal.dot(dual_c) / height) * plane_normal_;
  }
}

SphereTriangle::Foot SphereTriangle::foot(const Vec3& p) const noexcept {
  const Vec3 d = p - a_.centre;
  const Face& face = faces_[d.dot(plane_normal_) >= 0.0 ? 0 : 1];
  return {d.dot(face.normal) - a_.radius, d.dot(face.weight_b), d.dot(face.weight_c)};
}

unsigned SphereTriangle::candidate_edges(const Foot& foot) const noexcept {
  // |p − q| − r(q) is convex over the plane, so the line from the constrained minimum to the free
  // one leaves the triangle through an edge whose weight is negative at the free one
  return (foot.b + foot.c > 1.0 ? 1U : 0U) | (foot.b < 0.0 ? 2U : 0U) | (foot.c < 0.0 ? 4U : 0U);
}

double SphereTriangle::distance(const Vec3& p) const noexcept {
  unsigned edges = 7U;
  if (has_faces_) {
    const Foot f = foot(p);
    if (f.inside()) return f.distance;
    edges = candidate_edges(f);
  }
  double nearest = 1e30;
  for (std::size_t e = 0; e < 3; ++e) {
    if ((edges >> e & 1U) != 0) nearest = std::min(nearest, edges_[e].distance(p));
  }
  return nearest;
}

SurfacePoint SphereTriangle::query(const Vec3& p) const noexcept {
  unsigned edges = 7U;
  if (has_faces_) {
    const Foot f = foot(p);
    if (f.inside()) {
      const double a = 1.0 - f.b - f.c;
      return seen_from(p, a * a_.centre + f.b * b_.centre + f.c * c_.centre,
                       a * a_.radius + f.b * b_.radius + f.c * c_.radius,
                       a * a_.velocity + f.b * b_.velocity + f.c * c_.velocity, faces_[0].normal);
    }
    edges = candidate_edges(f);
  }
  SurfacePoint nearest;
  nearest.distance = 1e30;
  for (std::size_t e = 0; e < 3; ++e) {
    if ((edges >> e & 1U) == 0) continue;
    const SurfacePoint point = edges_[e].query(p);
    if (point.distance < nearest.distance) nearest = point;
  }
  return nearest;
}

PackedTriangle SphereTriangle::packed(const Vec3& origin) const noexcept {
  PackedTriangle out{};
  for (std::size_t e = 0; e < 3; ++e) out.edge[e] = edges_[e].packed(origin);
  // an error in the projection onto a face changes the distance by its square over the radius. In
  // thinner triangles that error in single precision exceeds the error of omitting the faces
  const Vec3 e1 = b_.centre - a_.centre, e2 = c_.centre - a_.centre;
  constexpr double kThinnest = 1e-8;  // squared sine of the angle between two edges
  out.has_faces =
      has_faces_ && e1.cross(e2).squaredNorm() > kThinnest * e1.squaredNorm() * e2.squaredNorm();
  if (!out.has_faces) return out;
  pack(a_.centre - origin, out.centre);
  pack(a_.velocity, out.velocity);
  out.radius = static_cast<float>(a_.radius);
  pack(plane_normal_, out.plane);
  // the parts that the two faces share, and those of opposite sign
  const Face &above = faces_[0], &below = faces_[1];
  pack(0.5 * (above.normal + below.normal), out.in_plane);
  out.height = static_cast<float>(above.normal.dot(plane_normal_));
  pack(0.5 * (above.weight_b + below.weight_b), out.dual_b);
  pack(0.5 * (above.weight_c + below.weight_c), out.dual_c);
  out.shear_b = static_cast<float>(-above.weight_b.dot(plane_normal_));
  out.shear_c = static_cast<float>(-above.weight_c.dot(plane_normal_));
  pack(b_.velocity - a_.velocity, out.change_b);
  pack(c_.velocity - a_.velocity, out.change_c);
  return out;
}

}  // namespace prostm
