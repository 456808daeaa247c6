#pragma once
/// Amplitude modulation, the baseline of [B-1]: converts a target pressure field to a few
/// stationary focal points (docs/design/am.md).

#include <memory>

#include "prostm/core/settings.hpp"
#include "prostm/plan/planner.hpp"

namespace prostm {

/// Defaults are those of [B-1]; σ is that of PRO-STM's Fig. 3.
struct AmSettings {
  int foci = 4;                 ///< N, maximum number of focal points, 1..8
  double sigma = 8.6e-3;        ///< fall-off σ of a focal point [m], 1 to 100 mm
  int lloyd_iterations = 1000;  ///< maximum; the field of a hand takes 5 to 50
  /// Weight of the percept when pressures and phases are chosen, 0 to 1, (B8); the field (B2) has
  /// the rest. 0: the pressures are (B3), and all foci are in phase.
  double felt_weight = 0.0;
  /// For felt_weight above 0, not stored in files: frequency of the modulation [Hz], and the
  /// array's own σ by the target's position and tilt; if empty, `sigma`.
  double frequency = 200.0;
  FocusWidths widths;

  void visit(SettingsReader& v) const;
  void visit(SettingsWriter& v);
  bool operator==(const AmSettings&) const = default;
};

/// @throws std::invalid_argument with a message that names the setting, its value and its bound.
void validate(const AmSettings& settings);

/// Plans the foci of targets, each from scratch. Deterministic: the same settings and targets give
/// bit-identical plans.
class AmPlanner {
 public:
  /// @param max_cells largest number of cells of a target passed to plan().
  /// @throws std::invalid_argument with a message that names the setting, its value and its bound.
  AmPlanner(const AmSettings& settings, std::size_t max_cells);
  ~AmPlanner();
  AmPlanner(AmPlanner&&) noexcept;
  AmPlanner& operator=(AmPlanner&&) noexcept;

  const AmSettings& settings() const;

  /// Plans foci for one patch, (B1) to (B3), ordered by descending pressure of their initial cells;
  /// `plan` is overwritten. There are fewer than N if fewer cells with pressure lie farther than σ
  /// from each other, or if a focus would reach no skin. Weights of the target are ignored.
  /// Fills the statistics `clusters` and `lloyd_iterations`, and the times `init` (the greedy
  /// start), `kmeans`, `refine` (the pressures) and `total`. Allocates and throws nothing.
  PlanStatus plan(const TargetField& target, Plan& plan, PlanStats& stats) noexcept;

  /// Plans foci for every patch of a frame. Foci are allocated to patches like paths by Planner.
  PlanStatus plan(const TargetFrame& frame, Plan& plan, PlanStats& stats) noexcept;

 private:
  struct Scratch;
  std::unique_ptr<Scratch> scratch_;
};

}  // namespace prostm
