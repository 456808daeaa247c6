#pragma once
/// Amplitude modulation, the baseline of [B-1]: from a target pressure field to a few focal points
/// that stand still (docs/design.md, AM baseline (B)).

#include <memory>

#include "prostm/core/settings.hpp"
#include "prostm/plan/planner.hpp"

namespace prostm {

/// Defaults are those of [B-1], and σ that of PRO-STM's Fig. 3.
struct AmSettings {
  int foci = 4;                 ///< N, at most, 1..8
  double sigma = 8.6e-3;        ///< fall-off σ of a focal point [m], 1 to 100 mm
  int lloyd_iterations = 1000;  ///< at most; a field of a hand takes 5 to 50

  void visit(SettingsReader& v) const;
  void visit(SettingsWriter& v);
  bool operator==(const AmSettings&) const = default;
};

/// Plans the foci of targets, each from scratch. Deterministic: the same settings and targets give
/// the same plans to the bit.
class AmPlanner {
 public:
  /// @param max_cells the largest raster that plan() will be given.
  /// @throws std::invalid_argument with a sentence that names the setting, its value and its bound.
  AmPlanner(const AmSettings& settings, std::size_t max_cells);
  ~AmPlanner();
  AmPlanner(AmPlanner&&) noexcept;
  AmPlanner& operator=(AmPlanner&&) noexcept;

  const AmSettings& settings() const;

  /// Foci for one patch, (B1) to (B3), in falling order of the pressure that they started at;
  /// `plan` is overwritten. Fewer than N where fewer cells with pressure lie farther than σ from
  /// each other, or where a focus would reach no skin. Weights of the target do not count. Of the
  /// statistics `clusters`, `lloyd_iterations` and the times `init` (the greedy start), `kmeans`
  /// and `refine` (the pressures) are filled. Allocates and throws nothing.
  PlanStatus plan(const TargetField& target, Plan& plan, PlanStats& stats) noexcept;

  /// Foci for every patch of a frame, shared out between them as paths are.
  PlanStatus plan(const TargetFrame& frame, Plan& plan, PlanStats& stats) noexcept;

 private:
  struct Scratch;
  std::unique_ptr<Scratch> scratch_;
};

}  // namespace prostm
