#pragma once
/// The bodies of hands, and kernels (scalar and vector) that query them for blocks of points.
/// Private to hand.

#include <boost/container/static_vector.hpp>
#include <cstdint>

#include "prostm/hand/detail/packed_body.hpp"
#include "prostm/hand/hand_shape.hpp"

namespace prostm {

/// Refers to the added bodies, which must not move.
class BodySet {
 public:
  static constexpr std::size_t kMaxHands = 2;
  static constexpr std::size_t kCapacity =
      kMaxHands * (HandShape::kMaxCones + HandShape::kMaxTriangles);
  static_assert(kCapacity <= 255, "a body's number must fit a byte");
  struct Body {
    const RoundCone* cone;  // of cone and triangle, one is null
    const SphereTriangle* triangle;
    std::size_t packed;  // index among the packed bodies of its kind
  };

  /// Removes all bodies; points are relative to `origin` from now on [m].
  void clear(const Vec3& origin) noexcept;
  /// @pre size() < kCapacity, and at most as many of each kind as kMaxHands hands have.
  void add(const RoundCone& cone) noexcept;
  void add(const SphereTriangle& triangle) noexcept;
  void add(const HandShape& shape) noexcept;

  std::size_t size() const { return bodies_.size(); }
  const Vec3& origin() const { return origin_; }
  const Body& operator[](std::size_t n) const { return bodies_[n]; }
  const PackedCone& cone(const Body& body) const { return cones_[body.packed]; }
  const PackedTriangle& triangle(const Body& body) const { return triangles_[body.packed]; }

 private:
  Vec3 origin_ = Vec3::Zero();
  boost::container::static_vector<Body, kCapacity> bodies_;
  boost::container::static_vector<PackedCone, kMaxHands * HandShape::kMaxCones> cones_;
  boost::container::static_vector<PackedTriangle, kMaxHands * HandShape::kMaxTriangles> triangles_;
};

/// Some bodies of a set by number, ascending.
struct BodyList {
  int count = 0;
  std::uint8_t body[BodySet::kCapacity];
};

/// Eight points, the corners of a cube: corner c is at the centre + half along x where bit 0 of c
/// is set, − half where not; bit 1 is y, bit 2 is z.
struct CubeCorners {
  float centre[3];  ///< relative to the set's origin [m]
  float half;       ///< [m]
};

/// The nearest body of a list at each of eight corners; of equally near bodies, the first one.
struct NearestBodies {
  alignas(32) float distance[8];  ///< [m]
  alignas(32) std::int32_t body[8];
};

struct BodyKernels {
  /// Points lie in blocks around eight corners, each within `reach` of its corner. Bit c of near[n]
  /// tells whether the list's n-th body can be the nearest of the list, and within `limit`,
  /// somewhere in the block of corner c. A distance changes at most as fast as the point moves.
  void (*cull)(const BodySet& bodies, const BodyList& list, const CubeCorners& corners, float reach,
               float limit, std::uint8_t* near);
  /// Finds the nearest body at each corner. @pre the list is not empty.
  void (*nearest)(const BodySet& bodies, const BodyList& list, const CubeCorners& corners,
                  NearestBodies& out);
  /// Computes the velocity of the nearest skin point of each corner's body [m/s], for the corners
  /// whose bit is set in `which`.
  void (*velocity)(const BodySet& bodies, const NearestBodies& nearest, const CubeCorners& corners,
                   unsigned which, float (*out)[8]);
};

/// Kernels that use the bodies' own distance() and query(), in double precision.
const BodyKernels& scalar_body_kernels();
/// Returns the vector kernels for this processor, in single precision, or the scalar ones if
/// Highway has only its one-lane fallback.
const BodyKernels& fast_body_kernels();

}  // namespace prostm
