// Converts a plan to the samples that an array plays: 40000 a second for every focal point.
#include <algorithm>
#include <cstdio>
#include <prostm/emit/loop_samples.hpp>
#include <prostm/plan/planner.hpp>

#include "two_bumps.hpp"

int main() {
  prostm::TargetFrame frame;  // the target at one time: a field for each hand
  frame.patches.push_back(two_bumps());
  prostm::PlanSettings settings;
  prostm::Planner planner(settings, frame.patches[0].size());
  prostm::Plan plan;
  prostm::PlanStats stats;
  planner.plan(frame, plan, stats);

  prostm::LiftedPlan lifted;  // in the array's frame, at the skin's heights
  prostm::lift(plan, frame, lifted);
  prostm::EmitSettings emission;
  emission.full_scale_pressure = settings.gain * prostm::max_pressure(frame.patches[0]);
  const prostm::LoopSamples loop = prostm::loop_samples(lifted, emission, 40e3);

  std::printf("%d samples of %d focal points, a loop of %.1f ms\n", loop.samples, loop.foci,
              1e3 * loop.samples / loop.sample_rate);
  for (int f = 0; f < loop.foci; ++f) {
    const prostm::FocusSample& first = loop.sample[static_cast<std::size_t>(f)];
    float largest = 0.0F;
    for (int k = 0; k < loop.samples; ++k) {
      largest =
          std::max(largest, loop.sample[static_cast<std::size_t>(k * loop.foci + f)].intensity);
    }
    std::printf("  starts at (%.0f, %.0f, %.0f) mm, %d laps, intensity up to %.2f\n",
                1e3 * first.p_D.x(), 1e3 * first.p_D.y(), 1e3 * first.p_D.z(),
                loop.laps[static_cast<std::size_t>(f)], largest);
  }
}
