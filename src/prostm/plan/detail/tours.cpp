#include "prostm/plan/detail/tours.hpp"

#include <algorithm>
#include <cmath>

#include "prostm/core/random.hpp"

namespace prostm::planning {
namespace {

constexpr int kTourStarts = 4;      // 2-opt runs of which the best is kept
constexpr double kGain = 1e-9;      // least gain of a reversal, so that rounding cannot cycle [mm]
constexpr double kThinWidth = 3.0;  // half the width of an ellipse that replaces a thin tour [mm]

/// Unit vector of largest weighted spread: the eigenvector of the covariance (P7) with the higher
/// eigenvalue.
Vec2 principal_direction(const Clusters& clusters, std::span<const std::uint8_t> members) {
  double mass = 0.0;
  Vec2 mean = Vec2::Zero();
  for (const std::size_t c : members) {
    mass += clusters.mass[c];
    mean += clusters.mass[c] * clusters.centre[c];
  }
  mean /= mass;
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (const std::size_t c : members) {
    const Vec2 d = clusters.centre[c] - mean;
    xx += clusters.mass[c] * d.x() * d.x();
    xy += clusters.mass[c] * d.x() * d.y();
    yy += clusters.mass[c] * d.y() * d.y();
  }
  const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
  return {std::cos(angle), std::sin(angle)};
}

struct Bounds {
  double low, high;
};

Bounds bounds_along(const Clusters& clusters, std::span<const std::uint8_t> members,
                    const Vec2& direction) {
  Bounds bounds{clusters.centre[members[0]].dot(direction),
                clusters.centre[members[0]].dot(direction)};
  for (const std::size_t c : members) {
    const double s = clusters.centre[c].dot(direction);
    bounds.low = std::min(bounds.low, s);
    bounds.high = std::max(bounds.high, s);
  }
  return bounds;
}

/// Samples a closed polygon at equal arc lengths from its first vertex on. @pre its length is > 0.
template <typename Vertex>
void resample_polygon(std::size_t count, const Vertex& vertex, std::span<Vec2> x) {
  double length = 0.0;
  for (std::size_t i = 0; i < count; ++i) length += (vertex((i + 1) % count) - vertex(i)).norm();
  std::size_t edge = 0;
  double start = 0.0, edge_length = (vertex(1) - vertex(0)).norm();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double s = length * static_cast<double>(i) / static_cast<double>(x.size());
    while (start + edge_length < s && edge + 1 < count) {
      start += edge_length;
      ++edge;
      edge_length = (vertex((edge + 1) % count) - vertex(edge)).norm();
    }
    const double t = edge_length > 0.0 ? std::min((s - start) / edge_length, 1.0) : 0.0;
    x[i] = vertex(edge) + t * (vertex((edge + 1) % count) - vertex(edge));
  }
}

}  // namespace

void DistanceTable::set(std::span<const Vec2> points) {
  for (std::size_t a = 0; a < points.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      table_[a][b] = table_[b][a] = (points[a] - points[b]).norm();
    }
  }
}

double tour_length(const DistanceTable& distance, std::span<const std::uint8_t> tour) {
  double length = 0.0;
  for (std::size_t i = 0; i < tour.size(); ++i)
    length += distance(tour[i], tour[(i + 1) % tour.size()]);
  return length;
}

void two_opt(const DistanceTable& distance, std::span<std::uint8_t> tour) {
  const std::size_t n = tour.size();
  if (n < 4) return;
  for (bool improved = true; improved;) {
    improved = false;
    for (std::size_t i = 0; i + 2 < n; ++i) {
      // edges (i, i+1) and (j, j+1) become (i, j) and (i+1, j+1)
      for (std::size_t j = i + 2; j < n; ++j) {
        const std::size_t after = j + 1 == n ? 0 : j + 1;
        if (after == i) continue;
        const double gain = distance(tour[i], tour[i + 1]) + distance(tour[j], tour[after]) -
                            distance(tour[i], tour[j]) - distance(tour[i + 1], tour[after]);
        if (gain <= kGain) continue;
        std::reverse(tour.begin() + static_cast<std::ptrdiff_t>(i + 1),
                     tour.begin() + static_cast<std::ptrdiff_t>(j + 1));
        improved = true;
      }
    }
  }
}

double shortest_tour(const DistanceTable& distance, std::span<std::uint8_t> tour,
                     std::uint64_t seed) {
  Tour order(tour.begin(), tour.end());
  two_opt(distance, tour);
  double shortest = tour_length(distance, tour);
  if (tour.size() < 4) return shortest;

  Random random(seed);
  for (int start = 1; start < kTourStarts; ++start) {
    random.shuffle(order);
    const std::span<std::uint8_t> candidate(order.data(), order.size());
    two_opt(distance, candidate);
    const double length = tour_length(distance, candidate);
    if (length >= shortest) continue;
    shortest = length;
    std::copy(order.begin(), order.end(), tour.begin());
  }
  return shortest;
}

boost::container::static_vector<Leaf, kMaxClusters> split_tours(const Clusters& clusters,
                                                                const DistanceTable& distance,
                                                                const Tour& whole,
                                                                double max_length,
                                                                std::uint64_t seed) {
  boost::container::static_vector<Leaf, kMaxClusters> leaves;
  boost::container::static_vector<Tour, kMaxClusters> open{whole};
  while (!open.empty()) {
    Tour tour = open.back();
    open.pop_back();
    const std::span<std::uint8_t> members(tour.data(), tour.size());
    const double length = shortest_tour(distance, members, seed);

    // split the set at the midpoint of its bounds
    Tour low, high;
    if (length > max_length) {
      const Vec2 direction = principal_direction(clusters, members);
      const Bounds bounds = bounds_along(clusters, members, direction);
      const double middle = 0.5 * (bounds.low + bounds.high);
      for (const std::uint8_t c : tour) {
        (clusters.centre[c].dot(direction) <= middle ? low : high).push_back(c);
      }
    }
    if (!low.empty() && !high.empty()) {
      open.push_back(low);
      open.push_back(high);
      continue;
    }
    Leaf leaf{tour, 0.0};
    for (const std::size_t c : tour) leaf.mass += clusters.mass[c];
    leaves.push_back(leaf);
  }

  // heaviest first, equal ones in the order found (insertion sort is stable and needs no heap)
  for (std::size_t i = 1; i < leaves.size(); ++i) {
    for (std::size_t j = i; j > 0 && leaves[j].mass > leaves[j - 1].mass; --j) {
      std::swap(leaves[j], leaves[j - 1]);
    }
  }
  return leaves;
}

void resample_tour(const Clusters& clusters, std::span<const std::uint8_t> tour,
                   std::span<Vec2> x) {
  const Vec2 along = principal_direction(clusters, tour), across(-along.y(), along.x());
  const Bounds length = bounds_along(clusters, tour, along),
               width = bounds_along(clusters, tour, across);
  if (0.5 * (width.high - width.low) >= kThinWidth) {
    resample_polygon(
        tour.size(), [&](std::size_t i) -> Vec2 { return clusters.centre[tour[i]]; }, x);
    return;
  }
  const Vec2 middle =
      0.5 * (length.low + length.high) * along + 0.5 * (width.low + width.high) * across;
  const double half_length = std::max(0.5 * (length.high - length.low), kThinWidth);
  constexpr std::size_t kVertices = 64;
  resample_polygon(
      kVertices,
      [&](std::size_t i) -> Vec2 {
        const double angle = 2.0 * kPi * static_cast<double>(i) / static_cast<double>(kVertices);
        return middle + half_length * std::cos(angle) * along +
               kThinWidth * std::sin(angle) * across;
      },
      x);
}

}  // namespace prostm::planning
