#include "prostm/plan/quasi_static/closest_point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace prostm {

PathSegments::PathSegments(const Plan& plan, int patch) {
  for (const FocalPath& path : plan.paths) {
    if (path.patch != patch) continue;
    const std::size_t n = path.points.size();
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t next = (i + 1) % n;
      add(path.points[i], path.points[next], path.pressure[i], path.pressure[next]);
    }
  }
  for (const FocalPoint& focus : plan.foci) {
    if (focus.patch == patch) add(focus.position, focus.position, focus.pressure, focus.pressure);
  }
}

void PathSegments::add(const Vec2& a, const Vec2& b, double pressure_a, double pressure_b) {
  const Vec2 edge = b - a;
  const double length2 = edge.squaredNorm();
  segments_[count_] = {a, edge, length2 > 0.0 ? 1.0 / length2 : 0.0, pressure_a,
                       pressure_b - pressure_a};
  Box& box = boxes_[count_ / kRun];
  if (count_ % kRun == 0) box = {a, a};
  box.low = box.low.cwiseMin(a).cwiseMin(b);
  box.high = box.high.cwiseMax(a).cwiseMax(b);
  ++count_;
}

double PathSegments::project(std::size_t s, const Vec2& x, double& along) const {
  const Segment& segment = segments_[s];
  const Vec2 d = x - segment.start;
  along = std::min(std::max(d.dot(segment.edge) * segment.inverse_length2, 0.0), 1.0);
  return (d - along * segment.edge).squaredNorm();
}

ClosestPoint PathSegments::closest(const Vec2& x) {
  ClosestPoint best;
  best.segment = last_;
  best.distance2 = project(last_, x, best.along);
  for (std::size_t begin = 0; begin < count_; begin += kRun) {
    // skip a run whose box is farther than the best so far
    const Box& box = boxes_[begin / kRun];
    const Vec2 outside = (box.low - x).cwiseMax(x - box.high).cwiseMax(0.0);
    if (outside.squaredNorm() > best.distance2) continue;
    for (std::size_t s = begin; s < std::min(begin + kRun, count_); ++s) {
      double along = 0.0;
      const double distance2 = project(s, x, along);
      if (distance2 > best.distance2 || (distance2 == best.distance2 && s >= best.segment))
        continue;
      best.distance2 = distance2;
      best.segment = s;
      best.along = along;
    }
  }
  last_ = best.segment;
  best.pressure = segments_[last_].pressure + best.along * segments_[last_].pressure_change;
  return best;
}

PathSegments::Near PathSegments::near(const Vec2& x, double radius) const {
  constexpr double kRounding = 1e-9;  // [m]
  std::array<double, kCapacity> distance2;
  double least = std::numeric_limits<double>::max(), along = 0.0;
  for (std::size_t s = 0; s < count_; ++s) {
    distance2[s] = project(s, x, along);
    least = std::min(least, distance2[s]);
  }
  // between x and a point within the radius, no distance differs by more than the radius
  const double most = std::sqrt(least) + 2.0 * radius + kRounding;
  Near out;
  for (std::size_t s = 0; s < count_; ++s) {
    if (distance2[s] <= most * most) out.push_back(static_cast<std::uint16_t>(s));
  }
  return out;
}

ClosestPoint PathSegments::closest(const Near& among, const Vec2& x) const {
  ClosestPoint best;
  best.distance2 = std::numeric_limits<double>::max();
  for (const std::size_t s : among) {
    double along = 0.0;
    const double distance2 = project(s, x, along);
    if (distance2 >= best.distance2) continue;
    best.distance2 = distance2;
    best.segment = s;
    best.along = along;
  }
  const Segment& segment = segments_[best.segment];
  best.pressure = segment.pressure + best.along * segment.pressure_change;
  return best;
}

}  // namespace prostm
