#pragma once
/// Compares the gradient of the cost of `fast` and `best` with differences.

#include <gtest/gtest.h>

#include <cmath>

#include "prostm/plan/detail/fit/descent.hpp"
#include "prostm/plan/detail/fit/fit_settings.hpp"

namespace prostm::test {

/// Counts central differences that disagree with a gradient.
struct GradientCheck {
  int tried = 0, off = 0;

  /// Compares the two on the cost of loops after a short descent.
  void add(const planning::CellTiles& cells, const planning::Loops& loops,
           const planning::PlayBounds& bounds = planning::PlayBounds::all(1.0F,
                                                                          planning::kAnySlope)) {
    planning::FitSettings settings = planning::fit_settings(PlanSettings{});
    settings.reconstruction.bounds = bounds;
    planning::Descent descent(planning::CellTiles::kMaxTiles, loops.samples, settings);
    planning::Fit fit;
    fit.loops = loops;
    descent.run(cells, fit, 10);
    const planning::Reconstruction& at = fit.reconstruction;
    for (std::size_t a = 0; a < loops.nodes(); a += 3) {
      const auto cost_at = [&](planning::NodeArray planning::Loops::*coordinate, float step) {
        planning::Fit moved = fit;
        (moved.loops.*coordinate)[a] += step;
        descent.evaluate(cells, moved);
        return moved.cost;
      };
      constexpr float kStep = 0.01F;
      using planning::Loops;
      compare((cost_at(&Loops::x, kStep) - cost_at(&Loops::x, -kStep)) / (2.0F * kStep),
              at.gradient_x[a]);
      compare((cost_at(&Loops::y, kStep) - cost_at(&Loops::y, -kStep)) / (2.0F * kStep),
              at.gradient_y[a]);
    }
  }
  /// The cost has kinks where a cell changes its closest segment, so a few differences may be off.
  void expect_agreement() const { EXPECT_LT(off, tried / 10) << off << " of " << tried; }

 private:
  void compare(float difference, float gradient) {
    ++tried;
    off += std::abs(difference - gradient) > 0.02F * std::abs(difference) + 0.02F ? 1 : 0;
  }
};

}  // namespace prostm::test
