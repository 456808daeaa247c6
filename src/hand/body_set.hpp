#pragma once
/// The bodies of hands, searched from blocks of points: which of them can be the nearest anywhere
/// in a block. Private to hand.

#include <boost/container/static_vector.hpp>
#include <cstdint>

#include "hand/hand_shape.hpp"

namespace prostm {

/// Refers to the shapes that were added; they must stay where they are.
class BodySet {
 public:
  static constexpr std::size_t kCapacity = 2 * (HandShape::kMaxCones + HandShape::kMaxTriangles);
  /// A body, and its distance at some point [m].
  struct Candidate {
    double distance;
    std::uint8_t body;
  };
  using List = boost::container::static_vector<Candidate, kCapacity>;

  void clear() { bodies_.clear(); }
  void add(const HandShape& shape) noexcept;
  /// Every body, with a distance below any.
  List all() const noexcept;

  /// The nearest body to p among `from`, whose distances are those at a point `step` away.
  /// Distances change at most as fast as the point moves, so a body that was too far there is not
  /// looked at. @pre `from` is not empty.
  Candidate nearest(const Vec3& p, const List& from, double step) const noexcept;
  /// The same, and in `kept` the bodies that can be nearest within `reach` of p, nearest first:
  /// none that is farther than 2 reach behind the nearest at p.
  Candidate nearest(const Vec3& p, const List& from, double step, double reach,
                    List& kept) const noexcept;

  SurfacePoint query(std::size_t body, const Vec3& p) const noexcept;

 private:
  struct Body {
    const RoundCone* cone;  // one of the two, the other is null
    const SphereTriangle* triangle;
    double distance(const Vec3& p) const {
      return cone != nullptr ? cone->distance(p) : triangle->distance(p);
    }
  };
  boost::container::static_vector<Body, kCapacity> bodies_;
};

}  // namespace prostm
