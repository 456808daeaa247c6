#pragma once
/// The bodies of hands, and what blocks of points ask about them: kernels written plain and with
/// vectors. Private to hand.

#include <boost/container/static_vector.hpp>
#include <cstdint>

#include "prostm/hand/detail/packed_body.hpp"
#include "prostm/hand/hand_shape.hpp"

namespace prostm {

/// Refers to the bodies that were added; they must stay where they are.
class BodySet {
 public:
  static constexpr std::size_t kMaxHands = 2;
  static constexpr std::size_t kCapacity =
      kMaxHands * (HandShape::kMaxCones + HandShape::kMaxTriangles);
  static_assert(kCapacity <= 255, "a body's number is one byte");
  struct Body {
    const RoundCone* cone;  // one of the two, the other is null
    const SphereTriangle* triangle;
    std::size_t packed;  // its place among the packed ones of its kind
  };

  /// Without a body; points are relative to `origin` from here on [m].
  void clear(const Vec3& origin) noexcept;
  /// @pre size() < kCapacity, and as many of each kind as kMaxHands hands have.
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

/// At each of eight corners the nearest body of a list, the first of equals.
struct NearestBodies {
  alignas(32) float distance[8];  ///< [m]
  alignas(32) std::int32_t body[8];
};

struct BodyKernels {
  /// Blocks of points stand around eight corners, each within `reach` of its corner. Bit c of
  /// near[n] tells whether the list's n-th body can be the nearest of the list, and within `limit`,
  /// somewhere in the block of corner c: a distance changes at most as fast as the point moves.
  void (*cull)(const BodySet& bodies, const BodyList& list, const CubeCorners& corners, float reach,
               float limit, std::uint8_t* near);
  /// @pre the list is not empty.
  void (*nearest)(const BodySet& bodies, const BodyList& list, const CubeCorners& corners,
                  NearestBodies& out);
  /// Velocities of the nearest skin point of each corner's own body [m/s], for the corners whose
  /// bit is set in `which`.
  void (*velocity)(const BodySet& bodies, const NearestBodies& nearest, const CubeCorners& corners,
                   unsigned which, float (*out)[8]);
};

/// By the bodies' own distance() and query(), in double precision.
const BodyKernels& scalar_body_kernels();
/// The vector kernels for this processor, in single precision; the plain ones where Highway knows
/// only its one-lane fallback.
const BodyKernels& fast_body_kernels();

}  // namespace prostm
