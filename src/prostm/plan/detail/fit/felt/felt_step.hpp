#pragma once
/// Chooses pressures, and optionally moves points, so that the percept resembles the target, (P19)
/// to (P21).

#include <array>
#include <cstdint>
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

/// Limits of a descent: the maximum number of evaluations, and the length of its first step in √p.
struct FeltEffort {
  int evaluations;
  float first_step;
};

/// Empirical constants; docs/measurements/felt-step.md has the experiment behind each.
struct FeltTuning {
  float least_root = 0.03F;  ///< least initial √p over the largest; at 0 its gradient would vanish
  float unit = 5.0F;         ///< move of a point that counts like a change of 1 in √p [mm]
  float near = 2.0F;         ///< distance within which a point continues one of the last plan [mm]
  float moved_near = 6.0F;   ///< same distance for moved points [mm]
  // descents of pressures: from the fit, from the fit because the last plan cost more, from the
  // last plan, after points were moved, and after those of the last plan were moved on
  FeltEffort from_fit = {12, 0.5F}, from_fit_again = {6, 0.5F}, from_last_plan = {6, 0.3F},
             from_moved = {30, 0.5F}, from_moved_on = {30, 0.5F};
  /// Descents that move points: the first, those after mending, and the first from the last plan.
  FeltEffort moving = {50, 0.5F}, moving_again = {25, 0.5F}, moving_on = {50, 0.5F};
};

/// How loud the result of a felt step is: like the initial pressures if the array can render that,
/// or as loud as the array can render it.
enum class FeltLoudness : std::uint8_t { Kept, Highest };

/// The felt step of a planner. Only construction allocates.
class FeltStep {
 public:
  explicit FeltStep(const PlanSettings& settings, const FeltTuning& tuning = {})
      : FeltStep(settings, tuning, felt_scope(settings), FeltLoudness::Kept) {}
  FeltStep(const PlanSettings& settings, const FeltTuning& tuning, const FeltScope& scope,
           FeltLoudness loudness);

  /// Forgets the last plan.
  void forget();
  /// Continues from the points of another step, instead of the last plan.
  void continue_from(const FeltStep& other) { kept_ = other.kept_; }
  /// Shifts the coordinates of the last plan [mm].
  void move(const Vec2& shift);
  /// Sets the target. @param maximum its largest pressure, > 0. @param sigma σ of a focus [m].
  void set_target(const TargetField& target, double maximum, double sigma);
  /// Chooses the pressures of paths in step, starting from those given. The points stay.
  /// @param pieces only every `pieces`-th point from its path's start is a variable; pressures
  /// between are interpolated. @param bounds limits of the emission. @return evaluations used.
  int choose_pressures(const Loops& loops, const LapStarts& starts, const CommonLoop& loop,
                       int pieces, const PlayBounds& bounds, NodeArray& pressure);
  /// Returns how these pressures of paths in step are felt, in the cells of this step.
  FeltRating rate(const Loops& loops, const LapStarts& starts, const CommonLoop& loop,
                  const NodeArray& pressure);
  /// Moves the points of paths in step together with their pressures. choose_pressures(), or
  /// another call with mended paths, continues from the result. @param shape weights and bounds of
  /// (P13)–(P15). @param bounds limits of the emission, with `pieces` per segment. @param pressure
  /// initial pressures. @return evaluations used.
  int move_points(const LapStarts& starts, const CommonLoop& loop, const ShapeSettings& shape,
                  const PlayBounds& bounds, int pieces, const NodeArray& pressure, Loops& loops);

 private:
  /// A point with its √p.
  struct Chosen {
    float x, y, root;
    float more;  ///< its √p minus the fit's
  };
  /// The points from which the next descent continues.
  struct Kept {
    enum class From { Nothing, LastPlan, MovedPoints } from = From::Nothing;
    std::vector<Chosen> points;
    bool moved_on = false;         ///< for moved points: whether they began at the last plan
    FeltProblem::Loudness wanted;  ///< for moved points: loudness of the fit before they moved
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
  const FeltLoudness loudness_;
  FeltProblem problem_;
  QuasiNewton descent_;
  Kept kept_;
  // scratch of one call, for each chosen point: position [mm], √p, √p of the fit, and its node
  std::vector<float> x_, y_, root_, fitted_;
  std::vector<std::size_t> node_;
  // scratch of move_points()
  Loops loops_;
  SpacedPairs pairs_;
  NodeArray shape_x_, shape_y_;
  std::vector<float> variables_;
};

}  // namespace prostm::planning
