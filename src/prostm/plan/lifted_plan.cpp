#include "prostm/plan/lifted_plan.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace prostm {
namespace {

constexpr double kSmoothingCells = 2.0;  // half-width of the kernel of (E1), in cells of the target

/// Length of the edge after point i.
double edge(const LiftedPath& path, std::size_t i) {
  return (i + 1 < path.s.size() ? path.s[i + 1] : path.length) - path.s[i];
}

using Lengths = boost::container::static_vector<double, kMaxLiftedPoints>;

/// The path in the plane, for (E1): the length of the edge after each point, and each point's
/// weight, half the length of its two edges.
struct FlatPath {
  Lengths edge, weight;
  double length = 0.0;

  explicit FlatPath(const LiftedPath& path) : length(path.length) {
    const std::size_t n = path.s.size();
    for (std::size_t i = 0; i < n; ++i) {
      edge.push_back(prostm::edge(path, i));
    }
    for (std::size_t i = 0; i < n; ++i) {
      weight.push_back(0.5 * (edge[i] + edge[i > 0 ? i - 1 : n - 1]));
    }
  }
};

/// Returns the height at point i under the triangular kernel of (E1) along the path.
double smooth_height(const FlatPath& flat, const Lengths& height, std::size_t i,
                     double half_width) {
  const std::size_t n = height.size();
  double weights = flat.weight[i];
  if (weights <= 0.0) return height[i];
  double sum = weights * height[i];
  // at most half the path's length, so that the opposite point has no weight from either side
  const double reach = std::min(half_width, 0.5 * flat.length), falloff = 1.0 / reach;
  const auto add = [&](std::size_t j, double distance) {
    const double weight = (1.0 - distance * falloff) * flat.weight[j];
    sum += weight * height[j];
    weights += weight;
  };
  double distance = flat.edge[i];
  for (std::size_t j = i; distance < reach; distance += flat.edge[j]) {
    j = j + 1 < n ? j + 1 : 0;
    add(j, distance);
  }
  std::size_t j = i > 0 ? i - 1 : n - 1;
  for (distance = flat.edge[j]; distance < reach; distance += flat.edge[j]) {
    add(j, distance);
    j = j > 0 ? j - 1 : n - 1;
  }
  return sum / weights;
}

/// Divides the segments into pieces: calls add(i, next, t) for the points from i (t = 0) to next
/// (t = 1, excluded). A path at rest has one point.
template <class Add>
void subdivide(const FocalPath& path, const Add& add) {
  const std::size_t n = path.points.size();
  const bool rests = std::all_of(path.points.begin(), path.points.end(),
                                 [&](const Vec2& x) { return x == path.points[0]; });
  if (rests) return add(std::size_t{0}, std::size_t{0}, 0.0);
  constexpr int kPieces = kLiftedPointsPerSegment;
  for (std::size_t i = 0; i < n; ++i) {
    for (int j = 0; j < kPieces; ++j) add(i, (i + 1) % n, static_cast<double>(j) / kPieces);
  }
}

/// Computes everything but the pressures.
void lift_points(const FocalPath& path, const TargetField& field, LiftedPath& out) {
  subdivide(path, [&](std::size_t i, std::size_t next, double t) {
    const Vec2 x = (1.0 - t) * path.points[i] + t * path.points[next];
    out.p_D.emplace_back(x.x(), x.y(), 0.0);
  });
  measure(out);

  // heights of the skin, smoothed along the flat path
  Lengths height;
  for (const Vec3& p : out.p_D) height.push_back(height_at(field, p.head<2>()));
  const double half_width = kSmoothingCells * field.cell;
  const FlatPath flat(out);
  for (std::size_t i = 0; i < out.p_D.size(); ++i) {
    out.p_D[i].z() = smooth_height(flat, height, i, half_width);
  }

  // from P to D
  for (Vec3& p : out.p_D) p = field.X_DP * p;
  measure(out);
}

void lift_path(const FocalPath& path, const TargetField& field, LiftedPath& out) {
  out.speed = path.speed;
  out.patch = path.patch;
  lift_points(path, field, out);
  subdivide(path, [&](std::size_t i, std::size_t next, double t) {
    out.pressure.push_back((1.0 - t) * path.pressure[i] + t * path.pressure[next]);
  });
}

}  // namespace

void lift(const Plan& plan, const TargetFrame& frame, LiftedPlan& out) noexcept {
  out.paths.clear();
  out.foci.clear();
  out.loop = plan.loop;
  for (const FocalPath& path : plan.paths) {
    if (path.points.empty()) continue;
    const auto patch = static_cast<std::size_t>(path.patch);
    assert(patch < frame.patches.size() && path.pressure.size() == path.points.size());
    out.paths.emplace_back();
    lift_path(path, frame.patches[patch], out.paths.back());
  }
  for (const FocalPoint& focus : plan.foci) {
    const auto patch = static_cast<std::size_t>(focus.patch);
    assert(patch < frame.patches.size());
    const TargetField& field = frame.patches[patch];
    const Vec3 p(focus.position.x(), focus.position.y(), height_at(field, focus.position));
    out.foci.push_back({field.X_DP * p, focus.pressure, focus.patch, focus.phase});
  }
}

double skin_length(const FocalPath& path, const TargetField& field) noexcept {
  LiftedPath lifted;
  lift_points(path, field, lifted);
  return lifted.length;
}

void measure(LiftedPath& path) noexcept {
  const std::size_t n = path.p_D.size();
  path.s.resize(n);
  path.length = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    path.s[i] = path.length;
    path.length += (path.p_D[i + 1 < n ? i + 1 : 0] - path.p_D[i]).norm();
  }
}

PathPoint point_at(const LiftedPath& path, double s) {
  if (path.length <= 0.0) return {path.p_D[0], path.pressure[0]};
  s -= path.length * std::floor(s / path.length);

  // the edge that contains s begins at the last point at or before it
  const auto after = std::upper_bound(path.s.begin(), path.s.end(), s);
  const auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - path.s.begin(), 1) - 1);
  const std::size_t next = i + 1 < path.s.size() ? i + 1 : 0;
  const double e = edge(path, i);
  const double t = e > 0.0 ? std::min((s - path.s[i]) / e, 1.0) : 0.0;
  return {path.p_D[i] + t * (path.p_D[next] - path.p_D[i]),
          path.pressure[i] + t * (path.pressure[next] - path.pressure[i])};
}

PathPlace nearest_place(const LiftedPath& path, const Vec3& p_D) {
  // nearest vertex
  const std::size_t n = path.p_D.size();
  std::size_t vertex = 0;
  double least = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < n; ++i) {
    const double d = (path.p_D[i] - p_D).squaredNorm();
    if (d < least) {
      least = d;
      vertex = i;
    }
  }

  // then the nearer of the two edges at it
  PathPlace best{path.s[vertex], std::sqrt(least), path.p_D[vertex], Vec3::Zero()};
  for (const std::size_t i : {vertex, (vertex + n - 1) % n}) {
    const Vec3 e = path.p_D[(i + 1) % n] - path.p_D[i];
    const double length = e.norm();
    if (length < 1e-12) continue;
    const double t = std::clamp((p_D - path.p_D[i]).dot(e) / (length * length), 0.0, 1.0);
    const Vec3 foot = path.p_D[i] + t * e;
    const double distance = (foot - p_D).norm();
    if (distance < best.distance || best.tangent.isZero(0.0)) {
      best = {path.s[i] + t * length, distance, foot, e / length};
    }
  }
  return best;
}

}  // namespace prostm
