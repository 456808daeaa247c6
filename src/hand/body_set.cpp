#include "hand/body_set.hpp"

#include <utility>

namespace prostm {

void BodySet::add(const HandShape& shape) noexcept {
  for (const RoundCone& cone : shape.cones()) bodies_.push_back({&cone, nullptr});
  for (const SphereTriangle& triangle : shape.triangles()) bodies_.push_back({nullptr, &triangle});
}

BodySet::List BodySet::all() const noexcept {
  List list;
  for (std::size_t n = 0; n < bodies_.size(); ++n)
    list.push_back({-1e30, static_cast<std::uint8_t>(n)});
  return list;
}

BodySet::Candidate BodySet::nearest(const Vec3& p, const List& from, double step) const noexcept {
  Candidate best{1e30, from.front().body};
  for (const Candidate& candidate : from) {
    if (candidate.distance - step >= best.distance) continue;
    const double distance = bodies_[candidate.body].distance(p);
    if (distance < best.distance) best = {distance, candidate.body};
  }
  return best;
}

BodySet::Candidate BodySet::nearest(const Vec3& p, const List& from, double step, double reach,
                                    List& kept) const noexcept {
  kept.clear();
  double nearest = 1e30;
  for (const Candidate& candidate : from) {
    if (candidate.distance - step > nearest + 2.0 * reach) continue;
    const double distance = bodies_[candidate.body].distance(p);
    kept.push_back({distance, candidate.body});
    if (distance < nearest) {
      nearest = distance;
      std::swap(kept.front(), kept.back());
    }
  }
  // drop those that were taken before the nearest was known
  for (std::size_t n = 1; n < kept.size();) {
    if (kept[n].distance > nearest + 2.0 * reach) {
      kept[n] = kept.back();
      kept.pop_back();
    } else {
      ++n;
    }
  }
  return kept.front();
}

SurfacePoint BodySet::query(std::size_t body, const Vec3& p) const noexcept {
  const Body& b = bodies_[body];
  return b.cone != nullptr ? b.cone->query(p) : b.triangle->query(p);
}

}  // namespace prostm
