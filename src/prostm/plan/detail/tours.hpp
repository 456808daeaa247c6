#pragma once
/// Path initialisation: closed tours through the clusters, split until each is short enough (the
/// paper's section IV-B).

#include <array>
#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <span>

#include "prostm/plan/clustering.hpp"

namespace prostm::planning {

/// A closed tour, as indices of clusters.
using Tour = boost::container::static_vector<std::uint8_t, kMaxClusters>;

/// Distances between all clusters [mm].
class DistanceTable {
 public:
  void set(std::span<const Vec2> points);
  double operator()(std::size_t a, std::size_t b) const { return table_[a][b]; }

 private:
  std::array<std::array<double, kMaxClusters>, kMaxClusters> table_{};
};

/// Length of the closed tour [mm].
double tour_length(const DistanceTable& distance, std::span<const std::uint8_t> tour);

/// 2-opt [Croes 1958]: reverses sections of the closed tour while that shortens it.
void two_opt(const DistanceTable& distance, std::span<std::uint8_t> tour);

/// Finds the shortest of a few 2-opt optima, from the order given and from seeded random orders.
/// @return its length [mm].
double shortest_tour(const DistanceTable& distance, std::span<std::uint8_t> tour,
                     std::uint64_t seed);

/// A tour that meets the length constraint, or can be split no further.
struct Leaf {
  Tour tour;
  double mass = 0.0;  ///< Σ p* of its clusters
};

/// Splits the clusters of `whole` (their shortest tour) recursively until every tour is at most
/// `max_length` [mm]: the cut is orthogonal to the principal direction of the weighted covariance
/// (P7), midway between the bounds along it.
/// @return leaves by descending mass.
boost::container::static_vector<Leaf, kMaxClusters> split_tours(const Clusters& clusters,
                                                                const DistanceTable& distance,
                                                                const Tour& whole,
                                                                double max_length,
                                                                std::uint64_t seed);

/// Samples the closed tour at x.size() equal arc lengths [mm]. Clusters within kThinWidth of a line
/// (or only one or two) enclose no area. Their tour is an ellipse about them, since a path that
/// doubles back on itself would start with coinciding samples.
void resample_tour(const Clusters& clusters, std::span<const std::uint8_t> tour, std::span<Vec2> x);

}  // namespace prostm::planning
