#pragma once
/// Pressures, and points if wanted, that make what is felt look like the target, (P19) to (P21).

#include <array>
#include <span>
#include <vector>

#include "prostm/felt/quasi_newton.hpp"
#include "prostm/plan/detail/fit/felt/common_loop.hpp"
#include "prostm/plan/detail/fit/felt/felt_problem.hpp"
#include "prostm/plan/detail/fit/loop_shape.hpp"
#include "prostm/plan/detail/fit/loops.hpp"
#include "prostm/plan/detail/fit/phases.hpp"
#include "prostm/plan/detail/fit/playable.hpp"

namespace prostm::planning {

/// How far a descent goes: evaluations at most, and the length of its first step in √p.
struct FeltEffort {
  int evaluations;
  float first_step;
};

/// Numbers without a derivation; docs/measurements/felt-step.md has the experiment behind each.
struct FeltTuning {
  float least_root = 0.03F;  ///< √p at the beginning, over the largest: at 0 it would stick
  float unit = 5.0F;         ///< [mm] that a step of points is as long as a step of 1 in √p
  float near = 2.0F;         ///< a point continues one of the last plan this near [mm]
  float moved_near = 6.0F;   ///< the same of moved points [mm]
  // of pressures: from the fit's, from the fit's where the last plan's cost more, from the last
  // plan's, and after points were moved
  FeltEffort from_fit = {12, 0.5F}, from_fit_again = {6, 0.5F}, from_last_plan = {6, 0.3F},
             from_moved = {30, 0.5F};
  FeltEffort moving = {50, 0.5F}, moving_again = {25, 0.5F};  ///< of points, and of mended points
};

/// Sized once; nothing else allocates.
class FeltStep {
 public:
  explicit FeltStep(const PlanSettings& settings, const FeltTuning& tuning = {});

  /// Forgets the last plan.
  void forget();
  /// Brings the last plan to other coordinates [mm].
  void move(const Vec2& shift);
  /// Takes over a target. @param maximum its largest pressure, > 0. @param sigma of a focus [m].
  void set_target(const TargetField& target, double maximum, double sigma);
  /// Chooses the pressures of paths in step: those given are where it begins. The points stay.
  /// @param pieces only each so many-th point is chosen, counted from its path's start; pressures
  /// are linear between. @param bounds of what can be played. @return evaluations used.
  int choose_pressures(const Loops& loops, const LapStarts& starts, const CommonLoop& loop,
                       int pieces, const PlayBounds& bounds, NodeArray& pressure);
  /// Moves the points of paths in step, while their pressures follow. choose_pressures(), or
  /// another call with mended paths, continues from there. @param shape of the paths, (P13)–(P15).
  /// @param bounds of what can be played, with `pieces` per segment. @param pressure where it
  /// begins. @return evaluations used.
  int move_points(const LapStarts& starts, const CommonLoop& loop, const ShapeSettings& shape,
                  const PlayBounds& bounds, int pieces, const NodeArray& pressure, Loops& loops);

 private:
  /// A point with its pressure.
  struct Chosen {
    float x, y, root;
    float more;  ///< how much its √p is above the fit's
  };
  /// The points that the next descent continues from.
  struct Kept {
    enum class From { Nothing, LastPlan, MovedPoints } from = From::Nothing;
    std::vector<Chosen> points;
    FeltProblem::Loudness wanted;  ///< of moved points: that of the fit before they moved
  };

  StepPoints take_points(const Loops& loops, const LapStarts& starts, const CommonLoop& loop,
                         int pieces);
  void take_fit(const NodeArray& pressure);
  float least_root() const;
  void begin_at_fit();
  void begin_at_kept();
  int descend(const QuasiNewton::Cost& cost, float fit_cost);
  void make_as_loud(const FeltProblem::Loudness& wanted, float most_pressure);
  void keep(Kept::From from, const FeltProblem::Loudness& wanted);
  float moved_cost(const CommonLoop& loop, const ShapeSettings& shape, const PlayBounds& bounds,
                   int pieces, std::span<const float> x, std::span<float> gradient);

  const FeltTuning tuning_;
  FeltProblem problem_;
  QuasiNewton descent_;
  Kept kept_;
  // scratch of one call, of each chosen point: its place [mm], √p, that of the fit, and its node
  std::vector<float> x_, y_, root_, fitted_;
  std::vector<std::size_t> node_;
  // scratch of move_points()
  Loops loops_;
  SpacedPairs pairs_;
  NodeArray shape_x_, shape_y_;
  std::vector<float> variables_;
};

}  // namespace prostm::planning
