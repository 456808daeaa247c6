#pragma once
/// A player of foci, shared by the tests of their emission.

#include <gtest/gtest.h>

#include <initializer_list>
#include <span>
#include <vector>

#include "emit/paths.hpp"
#include "prostm/emit/detail/focus_emitter.hpp"

namespace prostm::test {

/// Pulls an emitter of foci in blocks and records every sample.
struct FociPlayer {
  explicit FociPlayer(const EmitSettings& settings, double rate = 40e3)
      : emitter(settings, rate),
        foci(static_cast<std::size_t>(settings.foci)),
        watch(settings.foci, rate, settings.power_limit) {}

  void play(std::size_t samples) {
    const std::size_t begin = kept.size();
    kept.resize(begin + samples * foci);
    const std::span<FocusSample> block(kept.data() + begin, samples * foci);
    emitter.fill(static_cast<std::int64_t>(begin / foci), block);
    watch.look(block);
  }
  void submit(std::initializer_list<LiftedFocus> wanted, std::int64_t id = 1) {
    LiftedPlan& plan = emitter.draft();
    plan.paths.clear();
    plan.foci.assign(wanted.begin(), wanted.end());
    plan.id = id;
    emitter.submit();
  }
  const FocusSample& at(std::size_t sample, std::size_t focus) const {
    return kept[sample * foci + focus];
  }
  double intensity(std::size_t sample, std::size_t focus = 0) const {
    return static_cast<double>(at(sample, focus).intensity);
  }

  FocusEmitter emitter;
  std::size_t foci;
  Watch watch;
  std::vector<FocusSample> kept;
};

/// Checks that all recorded samples keep the bounds, and that foci move only between silent
/// samples.
inline void expect_within_bounds(const FociPlayer& player) {
  ASSERT_TRUE(player.watch.holds()) << "step " << player.watch.step << ", slew "
                                    << player.watch.slew << ", power " << player.watch.power;
  EXPECT_EQ(player.emitter.stats().max_focus_step, 0.0);
  for (std::size_t k = 1; k < player.kept.size() / player.foci; ++k) {
    for (std::size_t f = 0; f < player.foci; ++f) {
      if (player.at(k, f).p_D == player.at(k - 1, f).p_D) continue;
      ASSERT_EQ(player.intensity(k, f), 0.0);
      ASSERT_EQ(player.intensity(k - 1, f), 0.0);
    }
  }
}

/// Returns a focus 200 mm above the array.
inline LiftedFocus focus_at(double x, double y, double pressure, double phase = 0.0) {
  return {Vec3(x, y, 0.2), pressure, 0, phase};
}

}  // namespace prostm::test
