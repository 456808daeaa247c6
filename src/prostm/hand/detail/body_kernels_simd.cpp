#include "prostm/hand/detail/body_set.hpp"

// only vectors whose length is known at compile time, since points and results are structs of them
#ifndef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#endif
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prostm/hand/detail/body_kernels_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// A vector is a row of a cube's corners; every lane takes the same steps of (H9) and (H10). Where
// the scalar code branches to one of a cone's two spheres or its mantle, this computes the distance
// to the sphere at the clamped u. Both agree, since that distance is least at u.
HWY_BEFORE_NAMESPACE();
namespace prostm {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, 8>;
using V = hn::Vec<D>;
using DI = hn::RebindToSigned<D>;

struct Points {
  V x, y, z;
};

struct Answer {
  V distance;
  Points velocity;  // only if requested
};

HWY_INLINE V set(float value) {
  return hn::Set(D(), value);
}

/// Returns the corners from `first` on, one per lane.
HWY_INLINE Points corners_from(const CubeCorners& corners, std::size_t first) {
  alignas(32) static constexpr float kSide[3][8] = {
      {-1, 1, -1, 1, -1, 1, -1, 1}, {-1, -1, 1, 1, -1, -1, 1, 1}, {-1, -1, -1, -1, 1, 1, 1, 1}};
  const D d;
  const V half = set(corners.half);
  return {hn::MulAdd(hn::Load(d, kSide[0] + first), half, set(corners.centre[0])),
          hn::MulAdd(hn::Load(d, kSide[1] + first), half, set(corners.centre[1])),
          hn::MulAdd(hn::Load(d, kSide[2] + first), half, set(corners.centre[2]))};
}

HWY_INLINE Points minus(const Points& p, const float (&q)[3]) {
  return {hn::Sub(p.x, set(q[0])), hn::Sub(p.y, set(q[1])), hn::Sub(p.z, set(q[2]))};
}

HWY_INLINE V dot(const Points& p, const float (&q)[3]) {
  return hn::MulAdd(p.z, set(q[2]), hn::MulAdd(p.y, set(q[1]), hn::Mul(p.x, set(q[0]))));
}

/// p + u q
HWY_INLINE Points plus(const Points& p, V u, const float (&q)[3]) {
  return {hn::MulAdd(u, set(q[0]), p.x), hn::MulAdd(u, set(q[1]), p.y),
          hn::MulAdd(u, set(q[2]), p.z)};
}

HWY_INLINE Points all(const float (&q)[3]) {
  return {set(q[0]), set(q[1]), set(q[2])};
}

template <class M>
HWY_INLINE Points choose(M mask, const Points& yes, const Points& no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y),
          hn::IfThenElse(mask, yes.z, no.z)};
}

template <bool kVelocity>
HWY_INLINE Answer ask(const PackedCone& cone, const Points& p) {
  const D d;
  const Points from = minus(p, cone.centre);
  const V along = dot(from, cone.axis);
  const Points off = plus(from, hn::Neg(along), cone.axis);
  const V across_squared =
      hn::MulAdd(off.z, off.z, hn::MulAdd(off.y, off.y, hn::Mul(off.x, off.x)));
  const V k =
      hn::NegMulAdd(set(cone.sine), hn::Sqrt(across_squared), hn::Mul(set(cone.cosine), along));
  const V u = hn::Min(hn::Max(hn::Mul(k, set(cone.per_generator)), hn::Zero(d)), set(1.0F));
  const V rest = hn::NegMulAdd(u, set(cone.length), along);
  const V radius = hn::MulAdd(u, set(cone.growth), set(cone.radius));
  Answer answer;
  answer.distance = hn::Sub(hn::Sqrt(hn::MulAdd(rest, rest, across_squared)), radius);
  if constexpr (kVelocity) answer.velocity = plus(all(cone.velocity), u, cone.change);
  return answer;
}

/// Takes the result of an edge in the lanes where the edge is nearer.
template <bool kVelocity>
HWY_INLINE void take(const PackedCone& edge, const Points& p, Answer& best) {
  const Answer answer = ask<kVelocity>(edge, p);
  if constexpr (kVelocity) {
    const auto nearer = hn::Lt(answer.distance, best.distance);
    best.velocity = choose(nearer, answer.velocity, best.velocity);
  }
  best.distance = hn::Min(best.distance, answer.distance);
}

template <bool kVelocity>
HWY_INLINE Answer ask(const PackedTriangle& triangle, const Points& p) {
  const D d;
  Answer best;
  best.distance = set(1e30F);
  best.velocity = all(triangle.velocity);
  if (!triangle.has_faces) {
    for (const PackedCone& edge : triangle.edge) take<kVelocity>(edge, p, best);
    return best;
  }
  const Points from = minus(p, triangle.centre);
  const V above = hn::Abs(dot(from, triangle.plane));
  const V b = hn::NegMulAdd(set(triangle.shear_b), above, dot(from, triangle.dual_b));
  const V c = hn::NegMulAdd(set(triangle.shear_c), above, dot(from, triangle.dual_c));
  const V a = hn::Sub(set(1.0F), hn::Add(b, c));
  Answer face;
  face.distance = hn::Sub(hn::MulAdd(set(triangle.height), above, dot(from, triangle.in_plane)),
                          set(triangle.radius));
  if constexpr (kVelocity) {
    face.velocity = plus(plus(all(triangle.velocity), b, triangle.change_b), c, triangle.change_c);
  }
  const auto inside = hn::Ge(hn::Min(hn::Min(a, b), c), hn::Zero(d));
  if (hn::AllTrue(d, inside)) return face;
  // an edge is part of the body, so lanes that do not need it may take it as well
  const V weight[3] = {a, b, c};
  for (int e = 0; e < 3; ++e) {
    if (!hn::AllFalse(d, hn::Lt(weight[e], hn::Zero(d))))
      take<kVelocity>(triangle.edge[e], p, best);
  }
  best.distance = hn::IfThenElse(inside, face.distance, best.distance);
  if constexpr (kVelocity) best.velocity = choose(inside, face.velocity, best.velocity);
  return best;
}

template <bool kVelocity>
HWY_INLINE Answer ask(const BodySet& bodies, std::size_t n, const Points& p) {
  const BodySet::Body& body = bodies[n];
  return body.cone != nullptr ? ask<kVelocity>(bodies.cone(body), p)
                              : ask<kVelocity>(bodies.triangle(body), p);
}

void Cull(const BodySet& bodies, const BodyList& list, const CubeCorners& corners, float reach,
          float limit, std::uint8_t* near) {
  const D d;
  alignas(32) float distance[BodySet::kCapacity][8];
  for (std::size_t first = 0; first < 8; first += hn::Lanes(d)) {
    const Points p = corners_from(corners, first);
    V nearest = set(1e30F);
    for (int n = 0; n < list.count; ++n) {
      const V from = ask<false>(bodies, list.body[n], p).distance;
      hn::Store(from, d, distance[n]);
      nearest = hn::Min(nearest, from);
    }
    const V farthest = hn::Min(hn::Add(nearest, set(2.0F * reach)), set(limit + reach));
    for (int n = 0; n < list.count; ++n) {
      std::uint8_t bits[8] = {};  // as many as the store may touch
      hn::StoreMaskBits(d, hn::Le(hn::Load(d, distance[n]), farthest), bits);
      near[n] = static_cast<std::uint8_t>((first == 0 ? 0 : near[n]) | bits[0] << first);
    }
  }
}

void Nearest(const BodySet& bodies, const BodyList& list, const CubeCorners& corners,
             NearestBodies& out) {
  const D d;
  for (std::size_t first = 0; first < 8; first += hn::Lanes(d)) {
    const Points p = corners_from(corners, first);
    V least = ask<false>(bodies, list.body[0], p).distance;
    V who = set(static_cast<float>(list.body[0]));
    for (int n = 1; n < list.count; ++n) {
      const V from = ask<false>(bodies, list.body[n], p).distance;
      who = hn::IfThenElse(hn::Lt(from, least), set(static_cast<float>(list.body[n])), who);
      least = hn::Min(least, from);
    }
    hn::Store(least, d, out.distance + first);
    hn::Store(hn::ConvertTo(DI(), who), DI(), out.body + first);
  }
}

void Velocity(const BodySet& bodies, const NearestBodies& nearest, const CubeCorners& corners,
              unsigned which, float (*out)[8]) {
  const D d;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t first = 0; first < 8; first += lanes) {
    const Points p = corners_from(corners, first);
    const auto owner = hn::Load(DI(), nearest.body + first);
    Points velocity = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    std::int32_t last = -1;
    for (std::size_t c = first; c < first + lanes; ++c) {
      // neighbours mostly share their body; a body that recurs is evaluated again
      if ((which >> c & 1U) == 0 || nearest.body[c] == last) continue;
      last = nearest.body[c];
      const Answer answer = ask<true>(bodies, static_cast<std::size_t>(last), p);
      const auto own = hn::RebindMask(d, hn::Eq(owner, hn::Set(DI(), last)));
      velocity = choose(own, answer.velocity, velocity);
    }
    hn::StoreU(velocity.x, d, out[0] + first);
    hn::StoreU(velocity.y, d, out[1] + first);
    hn::StoreU(velocity.z, d, out[2] + first);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace prostm
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace prostm {
namespace {

HWY_EXPORT(Cull);
HWY_EXPORT(Nearest);
HWY_EXPORT(Velocity);

void cull(const BodySet& bodies, const BodyList& list, const CubeCorners& corners, float reach,
          float limit, std::uint8_t* near) {
  HWY_DYNAMIC_DISPATCH(Cull)(bodies, list, corners, reach, limit, near);
}
void nearest(const BodySet& bodies, const BodyList& list, const CubeCorners& corners,
             NearestBodies& out) {
  HWY_DYNAMIC_DISPATCH(Nearest)(bodies, list, corners, out);
}
void velocity(const BodySet& bodies, const NearestBodies& nearest_bodies,
              const CubeCorners& corners, unsigned which, float (*out)[8]) {
  HWY_DYNAMIC_DISPATCH(Velocity)(bodies, nearest_bodies, corners, which, out);
}

}  // namespace

const BodyKernels& fast_body_kernels() {
  static constexpr BodyKernels kernels{cull, nearest, velocity};
  // queried once: the query is slow in a virtual machine
  static const bool vectors = (hwy::SupportedTargets() & ~(HWY_SCALAR | HWY_EMU128)) != 0;
  return vectors ? kernels : scalar_body_kernels();
}

}  // namespace prostm
#endif  // HWY_ONCE
