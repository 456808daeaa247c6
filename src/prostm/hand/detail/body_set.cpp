#include "prostm/hand/detail/body_set.hpp"

#include <algorithm>

namespace prostm {
namespace {

Vec3 corner_of(const BodySet& bodies, const CubeCorners& corners, unsigned c) {
  Vec3 p = bodies.origin();
  for (unsigned a = 0; a < 3; ++a) {
    const float sign = (c >> a & 1U) != 0 ? 1.0F : -1.0F;
    p[a] += static_cast<double>(corners.centre[a]) + static_cast<double>(sign * corners.half);
  }
  return p;
}

double distance(const BodySet::Body& body, const Vec3& p) {
  return body.cone != nullptr ? body.cone->distance(p) : body.triangle->distance(p);
}

void cull(const BodySet& bodies, const BodyList& list, const CubeCorners& corners, float reach,
          float limit, std::uint8_t* near) {
  std::fill_n(near, list.count, std::uint8_t{0});
  for (unsigned c = 0; c < 8; ++c) {
    const Vec3 p = corner_of(bodies, corners, c);
    double from[BodySet::kCapacity], nearest = 1e30;
    for (int n = 0; n < list.count; ++n) {
      from[n] = distance(bodies[list.body[n]], p);
      nearest = std::min(nearest, from[n]);
    }
    const auto radius = static_cast<double>(reach);
    const double farthest = std::min(nearest + 2.0 * radius, static_cast<double>(limit) + radius);
    for (int n = 0; n < list.count; ++n) {
      if (from[n] <= farthest) near[n] = static_cast<std::uint8_t>(near[n] | 1U << c);
    }
  }
}

void nearest(const BodySet& bodies, const BodyList& list, const CubeCorners& corners,
             NearestBodies& out) {
  for (unsigned c = 0; c < 8; ++c) {
    const Vec3 p = corner_of(bodies, corners, c);
    double least = 1e30;
    out.body[c] = list.body[0];
    for (int n = 0; n < list.count; ++n) {
      const double from = distance(bodies[list.body[n]], p);
      if (from >= least) continue;
      least = from;
      out.body[c] = list.body[n];
    }
    out.distance[c] = static_cast<float>(least);
  }
}

void velocity(const BodySet& bodies, const NearestBodies& nearest, const CubeCorners& corners,
              unsigned which, float (*out)[8]) {
  for (unsigned c = 0; c < 8; ++c) {
    if ((which >> c & 1U) == 0) continue;
    const BodySet::Body& body = bodies[static_cast<std::size_t>(nearest.body[c])];
    const Vec3 p = corner_of(bodies, corners, c);
    const Vec3 v =
        body.cone != nullptr ? body.cone->query(p).velocity : body.triangle->query(p).velocity;
    for (int a = 0; a < 3; ++a) out[a][c] = static_cast<float>(v[a]);
  }
}

}  // namespace

void BodySet::clear(const Vec3& origin) noexcept {
  origin_ = origin;
  bodies_.clear();
  cones_.clear();
  triangles_.clear();
}

void BodySet::add(const RoundCone& cone) noexcept {
  bodies_.push_back({&cone, nullptr, cones_.size()});
  cones_.push_back(cone.packed(origin_));
}

void BodySet::add(const SphereTriangle& triangle) noexcept {
  bodies_.push_back({nullptr, &triangle, triangles_.size()});
  triangles_.push_back(triangle.packed(origin_));
}

void BodySet::add(const HandShape& shape) noexcept {
  for (const RoundCone& cone : shape.cones()) add(cone);
  for (const SphereTriangle& triangle : shape.triangles()) add(triangle);
}

const BodyKernels& scalar_body_kernels() {
  static constexpr BodyKernels kernels{cull, nearest, velocity};
  return kernels;
}

}  // namespace prostm
