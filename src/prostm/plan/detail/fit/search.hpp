#pragma once
/// The search of the presets `fast` and `best`: starts, descent, and kicks that re-initialise one
/// or two paths.

#include <cstdint>

#include "prostm/core/random.hpp"
#include "prostm/core/stage_timer.hpp"
#include "prostm/plan/detail/fit/descent.hpp"
#include "prostm/plan/detail/fit/initial_loops.hpp"
#include "prostm/plan/detail/fit/raster/cell_tiles.hpp"

namespace prostm::planning {

/// Limits of a search, in evaluations of the error and its gradient.
struct SearchSettings {
  int samples = 20;            ///< samples of each path
  int starts = 4;              ///< new sets of paths tried without a previous plan
  int start_evaluations = 30;  ///< evaluations of each start
  int kicks = 20;              ///< attempts to re-initialise one or two paths
  int kick_evaluations = 25;   ///< evaluations of each kick
  int fewer_evaluations = 15;  ///< evaluations after removing a path; 0: no path is removed
  int small_evaluations = 0;   ///< least evaluations of each start if one path suffices
  int warm_starts = 1;         ///< new sets of paths tried in addition to the previous plan
  int warm_evaluations = 20;   ///< evaluations of the previous plan on the new target
  int final_evaluations = 30;  ///< evaluations of the winner, on the fine cells
  double hysteresis = 0.03;    ///< share by which a new start must be cheaper than the last plan
  double coarse_width = 4.0;   ///< width of the cells for starts and kicks [mm]
  double fine_width = 2.0;     ///< width of the cells for the final evaluations [mm]
  /// Whether the search, not only solve(), includes the cost of steep pressures.
  bool counts_steepness = true;
  int fine_paths = kMaxPaths;  ///< most needed paths of a target for which fine cells are used
  int region_passes = 6;       ///< passes of clustering the cells into one region per path
  int stop_passes = 4;         ///< passes of clustering a region into stops
  double weak = 0.01;          ///< initial tours ignore cells below this share of the highest
  std::uint64_t seed = 1;
};

/// Searches paths for one target after another. run() allocates nothing.
class Search {
 public:
  Search(std::size_t max_cells, const FitSettings& fit, const SearchSettings& settings);

  /// Begins a plan for a target. @param budget time for the plan [s], which replaces the number of
  /// kicks; 0: only the counts apply. @pre maximum > 0.
  void set_target(const TargetField& target, double maximum, double budget);

  /// Fits at most `paths` paths. @param continues whether to start from best.loops, the paths of
  /// the previous plan. @return evaluations used.
  int run(int paths, bool continues, Fit& best);
  /// Fits the paths of `fit`, which are not those of the previous plan, without trying others.
  /// @return evaluations used.
  int follow(Fit& fit);
  /// Sets σ of focal points, from the next target on [mm].
  void set_sigma(double sigma);
  /// Sets the limits of the emission, from the next target on.
  void set_bounds(const PlayBounds& bounds);
  /// Lowers the cost of `fit` further on the fine cells. @param most_length bound of each path's
  /// length [mm].
  int finish(const std::array<float, kMaxPaths>& most_length, Fit& fit);
  /// Takes the measured time of the steps after finish() into account in later budgets [s].
  void learn_ending(double seconds);
  /// Solves the pressures at the positions of `fit`, on the fine cells and under `bounds`. The
  /// paths may have more samples than those of the search.
  void solve(const PlayBounds& bounds, Fit& fit);

 private:
  /// The fine cells, or the coarse ones if the target has no fine cells of its own.
  const CellTiles& fine() const { return has_fine_ ? fine_ : coarse_; }
  StartSettings draw_start(int paths);
  int needed_paths() const;
  int try_starts(int paths, int starts, int most, float hysteresis, Fit& best);
  int try_kicks(Fit& best);
  int try_fewer(Fit& best);
  int remove_path(const Fit& from, Fit& out);
  const CellTiles& finish_cells() const { return finish_fine_ ? fine() : coarse_; }
  double evaluation_time(const CellTiles& cells) const;
  double finish_end() const { return budget_ - ending_time_ - kDeviations * ending_deviation_; }
  void share_budget();
  int affordable(int evaluations) const;
  int descend(const CellTiles& cells, int evaluations, double end, Fit& fit);

  SearchSettings settings_;
  CellTiles coarse_, fine_;
  InitialLoops initial_;
  Descent descent_;
  Random random_;
  Fit trial_, without_;
  Loops laid_;
  StageTimer timer_;
  float reached_ = 0.0F;  // least cost since starts were made, over the target's square norm
  static constexpr double kDeviations = 3.0;  // margin for the varying time after finish()
  // for a budget [s]: the measured time of an evaluation per tile and of the steps after finish(),
  // and the time by which starts and kicks must end to leave time for finish()
  double budget_ = 0.0, tile_time_ = 1.5e-7, search_end_ = 0.0;
  double ending_time_ = 8e-5, ending_deviation_ = 1e-5;
  int needed_ = 1;           // number of paths that the target needs
  bool has_fine_ = false;    // whether the target has fine cells of its own
  bool finish_fine_ = true;  // whether there is time to finish on the fine cells
};

}  // namespace prostm::planning
