#pragma once
/// Weighted k-means: the downsampled pressure points D of the paper's section IV-A.

#include <array>
#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <span>
#include <vector>

#include "prostm/core/geometry.hpp"

namespace prostm::planning {

inline constexpr int kMaxClusters = 50;  ///< the paper's bound, set by the cost of 2-opt

struct Clusters {
  /// Weighted means, unit of the points.
  boost::container::static_vector<Vec2, kMaxClusters> centre;
  boost::container::static_vector<double, kMaxClusters> mass;  ///< Σ weight, > 0
};

/// Minimises Σ w ‖x − centre(x)‖² (P1) by Lloyd's iteration, from k-means++ seeds or from given
/// ones. Sized once; run() and run_from() allocate nothing.
class WeightedKMeans {
 public:
  explicit WeightedKMeans(std::size_t max_points);

  void clear();
  /// Adds a point, in any unit, of positive weight. @pre points are distinct, no more than
  /// max_points.
  void add(const Vec2& point, double weight);
  std::size_t size() const { return x_.size(); }

  /// Clusters the points into min(k, size()). @return Lloyd iterations done, at most
  /// `max_iterations`.
  int run(int k, int max_iterations, std::uint64_t seed, Clusters& clusters);
  /// Same as run(), but from given seeds: every point starts at the nearest; ties go to the first.
  /// @pre 1 <= seeds.size() <= kMaxClusters.
  int run_from(std::span<const Vec2> seeds, int max_iterations, Clusters& clusters);

 private:
  void seed_centres(std::uint64_t seed);
  void place_seed(std::size_t c, double x, double y);
  int iterate(int max_iterations, Clusters& clusters);
  void sort_neighbours();
  bool assign();
  void move_centres();

  int k_ = 0;
  std::vector<double> x_, y_, weight_, distance2_;
  std::vector<std::uint8_t> label_;
  std::array<double, kMaxClusters> cx_{}, cy_{}, mass_{};
  /// For each centre, all centres by distance: neighbour_[c][0] is c itself.
  std::array<std::array<std::uint8_t, kMaxClusters>, kMaxClusters> neighbour_{};
  std::array<std::array<double, kMaxClusters>, kMaxClusters> separation2_{};
};

}  // namespace prostm::planning
