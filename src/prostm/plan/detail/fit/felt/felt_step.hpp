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

/// Sized once; nothing else allocates.
class FeltStep {
 public:
  explicit FeltStep(const PlanSettings& settings);

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
  /// Moves the points of paths in step, while their pressures follow; choose_pressures(), or
  /// another call with mended paths, goes on from there. @param shape of the paths, (P13)–(P15).
  /// @param bounds of what can be played, with `pieces` per segment. @param pressure where it
  /// begins. @return evaluations used.
  int move_points(const LapStarts& starts, const CommonLoop& loop, const ShapeSettings& shape,
                  const PlayBounds& bounds, int pieces, const NodeArray& pressure, Loops& loops);

 private:
  /// A chosen point of the last plan or of move_points().
  struct Chosen {
    float x, y, root;
    float more;  ///< how much its √p is above the fit's
  };
  /// Where the pressures begin: at the fit's; there after all, since the last plan's were worse; at
  /// those of the last plan, or of moved points.
  enum class From { Fit, FitAgain, LastPlan, MovedPoints };

  void take_points(const Loops& loops, const LapStarts& starts, int pieces);
  void fit(const NodeArray& pressure);
  void begin();
  void remember(From from);
  void join(const Loops& loops, const LapStarts& starts, int pieces, NodeArray& pressure) const;
  float moved_cost(const ShapeSettings& shape, const PlayBounds& bounds, int pieces,
                   std::span<const float> x, std::span<float> gradient);
  StepPoints points() const { return {samples_, x_, y_}; }

  FeltProblem problem_;
  QuasiNewton descent_;
  From from_ = From::Fit;
  int samples_ = 0;
  CommonLoop loop_;
  FeltProblem::Loudness wanted_;  // of the fit
  std::vector<Chosen> last_;
  // of each chosen point: its place [mm], √p, that of the fit, and its node
  std::vector<float> x_, y_, root_, fitted_;
  std::vector<std::size_t> node_;
  // for moved points
  Loops loops_;
  SpacedPairs pairs_;
  NodeArray shape_x_, shape_y_;
  std::vector<float> variables_;
};

}  // namespace prostm::planning
