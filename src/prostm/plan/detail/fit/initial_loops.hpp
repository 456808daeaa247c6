#pragma once
/// Initial paths: the plane is divided into one region per path, and each path tours its region.

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
  int stops = 16;                          ///< maximum number of clusters in a path's tour
  double most_length = 140;                ///< longest tour [mm]
  int region_passes = 6, stop_passes = 4;  ///< passes of Lloyd's iteration
};

/// Runs weighted k-means twice: on the cells with pressure for one region per path, then on each
/// region for its stops. If a tour of the stops (2-opt) is too long, the stops that cost most
/// length for their mass are dropped. make() allocates nothing.
class InitialLoops {
 public:
  explicit InitialLoops(std::size_t max_cells);

  /// Copies the cells whose weighted pressure is at least `weak`, > 0, times the highest. @pre some
  /// cell with positive weight has pressure.
  void set(const CellTiles& cells, float weak);
  /// Same, but only the cells whose closest path is in the set `owners` (one bit per path).
  void set(const CellTiles& cells, float weak,
           const std::vector<ReconstructionScratch::TileFit>& fits, int lanes,
           std::uint32_t owners);
  /// Number of cells copied.
  std::size_t size() const { return size_; }

  /// Fills `loops` with settings.paths paths, or with one per cell if there are fewer cells.
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
  std::vector<Moments> moments_;  // for the cells of the group being clustered
  Clusters centres_;
  DistanceTable distance_;
};

}  // namespace prostm::planning
