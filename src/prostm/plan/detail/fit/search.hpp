#pragma once
/// The search behind the presets `fast` and `best`: starts, descent, and kicks that lay one or two
/// paths anew.

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
  int starts = 4;              ///< sets of paths laid anew without a plan before
  int start_evaluations = 30;  ///< evaluations of each start
  int kicks = 20;              ///< tries to lay one or two paths anew
  int kick_evaluations = 25;   ///< evaluations of each kick
  int fewer_evaluations = 15;  ///< evaluations after a path is taken away; 0: paths are kept
  int small_evaluations = 0;   ///< least evaluations of each start if one path could do
  int warm_starts = 1;         ///< sets of paths laid anew beside a plan before
  int warm_evaluations = 20;   ///< evaluations of the plan before on the new target
  int final_evaluations = 30;  ///< evaluations of the winner, on the fine cells
  double hysteresis = 0.03;    ///< share by which a new start must be cheaper than the plan before
  double coarse_width = 4.0;   ///< width of the cells that starts and kicks are tried on [mm]
  double fine_width = 2.0;     ///< width of the cells that the winner is finished on [mm]
  /// Whether the search too, not only solve(), counts pressures that are too steep.
  bool counts_steepness = true;
  int fine_paths = kMaxPaths;  ///< the most paths of a target for which fine cells are worthwhile
  int region_passes = 6;       ///< passes of clustering the cells into one region per path
  int stop_passes = 4;         ///< passes of clustering a region into stops
  double weak = 0.01;          ///< cells below this share of the highest are not toured
  std::uint64_t seed = 1;
};

/// Sized once; run() allocates nothing.
class Search {
 public:
  Search(std::size_t max_cells, const FitSettings& fit, const SearchSettings& settings);

  /// Begins a plan: takes over the target. @param budget time for the plan, which replaces the
  /// number of kicks [s]; 0: only the counts apply. @pre maximum > 0.
  void set_target(const TargetField& target, double maximum, double budget);

  /// Fits at most `paths` paths. @param continues whether best.loops are the paths of the plan
  /// before, to start from. @return evaluations used.
  int run(int paths, bool continues, Fit& best);
  /// Sets σ of focal points, from the next target on [mm].
  void set_sigma(double sigma);
  /// Sets what the emission can play, from the next target on.
  void set_bounds(const PlayBounds& bounds);
  /// Lowers the cost of `fit` further on the fine cells, under the given bounds of length [mm].
  int finish(const std::array<float, kMaxPaths>& most_length, Fit& fit);
  /// Reports the time that the steps after finish() took, for the budgets to come [s].
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
  int take_away(const Fit& from, Fit& out);
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
  static constexpr double kDeviations = 3.0;  // margin, since the ending's time varies
  // for a budget [s]: the measured time of an evaluation per tile and of the steps after the
  // finish, and the time by which starts and kicks must end, so that the finish is in time
  double budget_ = 0.0, tile_time_ = 1.5e-7, search_end_ = 0.0;
  double ending_time_ = 8e-5, ending_deviation_ = 1e-5;
  int needed_ = 1;           // paths that the target asks for
  bool has_fine_ = false;    // whether it has fine cells of its own
  bool finish_fine_ = true;  // whether there is time to finish on the fine cells
};

}  // namespace prostm::planning
