#pragma once
/// The search behind the presets `fast` and `best`: starts, descent, and kicks that lay one or two
/// paths anew.

#include <cstdint>

#include "prostm/core/random.hpp"
#include "prostm/core/stage_timer.hpp"
#include "prostm/plan/detail/fit/cell_tiles.hpp"
#include "prostm/plan/detail/fit/descent.hpp"
#include "prostm/plan/detail/fit/initial_loops.hpp"

namespace prostm::planning {

/// What a search may cost, in evaluations of the error and its gradient.
struct SearchSettings {
  int samples = 20;            ///< of each path
  int starts = 4;              ///< laid anew when there is no plan before
  int start_evaluations = 30;  ///< of each start
  int kicks = 20;              ///< tries to lay one or two paths anew
  int kick_evaluations = 25;   ///< of each kick
  int fewer_evaluations = 15;  ///< of the paths that are left when one is taken away; 0: none is
  int small_evaluations = 0;   ///< of each start where one path could do, at least
  int warm_starts = 1;         ///< laid anew beside a plan before
  int warm_evaluations = 20;   ///< of the plan before on the new target
  int final_evaluations = 30;  ///< of the winner, on the fine cells
  double hysteresis = 0.03;    ///< by which a new start must be cheaper than the plan before
  double coarse_width = 4.0;   ///< of the cells that starts and kicks are tried on [mm]
  double fine_width = 2.0;     ///< of the cells that the winner is finished on [mm]
  /// Whether it matters to the search that pressures are too steep, not only to solve().
  bool counts_steepness = true;
  int fine_paths = kMaxPaths;  ///< most paths that a target may ask for to be worth the fine cells
  int region_passes = 6;       ///< of clustering the cells into one region for each path
  int stop_passes = 4;         ///< of clustering a region into stops
  double weak = 0.01;          ///< cells below are not toured, over the highest
  std::uint64_t seed = 1;
};

/// Sized once; run() allocates nothing.
class Search {
 public:
  Search(std::size_t max_cells, const FitSettings& fit, const SearchSettings& settings);

  /// Begins a plan: takes over the target. @param budget time for the plan, in place of the number
  /// of kicks [s]; 0: the counts bind. @pre maximum > 0.
  void set_target(const TargetField& target, double maximum, double budget);

  /// Fits at most `paths` paths. @param continues whether best.loops are the paths of the plan
  /// before, to start from. @return evaluations used.
  int run(int paths, bool continues, Fit& best);
  /// Of focal points, from the next target on [mm].
  void set_sigma(double sigma);
  /// What the emission can play, from the next target on.
  void set_bounds(const PlayBounds& bounds);
  /// Lowers the cost of `fit` further on the fine cells, under the given bounds of length [mm].
  int finish(const std::array<float, kMaxPaths>& most_length, Fit& fit);
  /// Tells how long what follows finish() took, for the budgets to come [s].
  void learn_ending(double seconds);
  /// Solves the pressures at the places of `fit`, on the fine cells: what `bounds` lets play, to
  /// the last digit. The paths may have more samples than those that are searched for.
  void solve(const PlayBounds& bounds, Fit& fit);

 private:
  /// The fine cells; the coarse ones are fine enough where both have the same width.
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
  static constexpr double kDeviations = 3.0;  // since the ending's time varies
  // for a budget: time of an evaluation per tile and of what follows the finish, as measured, and
  // when starts and kicks must end, so that the finish is in time [s]
  double budget_ = 0.0, tile_time_ = 1.5e-7, search_end_ = 0.0;
  double ending_time_ = 8e-5, ending_deviation_ = 1e-5;
  int needed_ = 1;           // paths that the target asks for
  bool has_fine_ = false;    // whether it has fine cells of its own
  bool finish_fine_ = true;  // whether there is time to finish on the fine cells
};

}  // namespace prostm::planning
