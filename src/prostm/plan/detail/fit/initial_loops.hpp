#pragma once
/// Initial paths: the plane is shared out among them jointly, and each tours its own region.

#include <array>
#include <cstddef>
#include <vector>

#include "prostm/core/random.hpp"
#include "prostm/plan/clustering.hpp"
#include "prostm/plan/detail/fit/loops.hpp"
#include "prostm/plan/detail/fit/raster/cell_tiles.hpp"
#include "prostm/plan/detail/fit/raster/reconstruction.hpp"
#include "prostm/plan/detail/tours.hpp"

namespace prostm::planning {

/// Settings of one start.
struct StartSettings {
  int paths = 4;
  int stops = 16;                          ///< most clusters that a path tours
  double most_length = 140;                ///< longest tour [mm]
  int region_passes = 6, stop_passes = 4;  ///< passes of Lloyd's iteration
};

/// Runs weighted k-means twice: on the cells with pressure for one region per path, then on each
/// region for its stops. A tour of the stops (2-opt) that is too long leaves out those that cost
/// most length for their mass. Sized once; make() allocates nothing.
class InitialLoops {
 public:
  explicit InitialLoops(std::size_t max_cells);

  /// Takes over the cells whose weighted pressure is at least `weak`, > 0, times the highest. @pre
  /// some cell that counts has pressure.
  void set(const CellTiles& cells, float weak);
  /// The same, but only the cells whose closest path is in the set `owners` (a bit each).
  void set(const CellTiles& cells, float weak,
           const std::vector<ReconstructionScratch::TileFit>& fits, int lanes,
           std::uint32_t owners);
  /// Number of cells taken over.
  std::size_t size() const { return size_; }

  /// Fills `loops` with as many paths as asked for, or one for each cell if there are fewer cells.
  /// @pre size() > 0.
  void make(const StartSettings& settings, int samples, Random& random, Loops& loops);

 private:
  struct Group {
    std::size_t begin, end;
  };
  using Centres = std::array<float, kMaxClusters>;
  using Moments = Eigen::Array4f;  // weight, weight · x, weight · y, 0
  void weigh();
  void seed(Group group, std::size_t count, Random& random, Centres& cx, Centres& cy) const;
  void cluster(Group group, int k, int passes, Random& random);
  void sort_by_label(int k, std::array<Group, kMaxPaths>& groups);
  void tour(const StartSettings& settings, std::span<Vec2> samples);

  std::size_t size_ = 0;
  std::vector<float> x_, y_, pressure_, weight_, sorted_[3];  // pressure_ is weighted
  std::vector<std::int32_t> label_;
  std::vector<Moments> moments_;  // for the cells of the group that is clustered
  Clusters centres_;
  DistanceTable distance_;
};

}  // namespace prostm::planning
