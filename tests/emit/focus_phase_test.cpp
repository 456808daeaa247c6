// Foci whose modulations have individual phases.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "emit/foci.hpp"
#include "prostm/emit/detail/envelope.hpp"
#include "prostm/emit/loop_samples.hpp"

namespace prostm {
namespace {

using test::focus_at;
using test::settings_for;
using Player = test::FociPlayer;

constexpr std::size_t kPeriod = 200;  // samples of 200 Hz at 40 kHz

/// (B7) with |sin|, at a sample of the period.
double a_of(std::size_t sample, double phase) {
  return std::abs(std::sin(kPi * (static_cast<double>(sample) / kPeriod - phase)));
}

TEST(FocusPhase, EachFocalPointStartsAtItsOwnZero) {
  Player player(settings_for(3));
  player.submit(
      {focus_at(0.0, 0.0, 1.0), focus_at(0.04, 0.0, 0.25, 0.25), focus_at(0.08, 0.0, 1.0, 0.9)});
  player.play(3 * kPeriod);
  for (std::size_t k = 0; k < 3 * kPeriod; ++k) {
    EXPECT_NEAR(player.intensity(k, 0), a_of(k, 0.0), 1e-6) << k;
    EXPECT_NEAR(player.intensity(k, 1), k < 50 ? 0.0 : 0.5 * a_of(k, 0.25), 1e-6) << k;
    EXPECT_NEAR(player.intensity(k, 2), k < 180 ? 0.0 : a_of(k, 0.9), 1e-6) << k;
  }
  EXPECT_TRUE(player.watch.holds());
}

TEST(FocusPhase, ANewPlanStartsAtTheZerosOfEachAndKeepsThePhases) {
  Player player(settings_for(2));
  player.submit({focus_at(0.0, 0.0, 1.0, 0.1), focus_at(0.08, 0.0, 1.0, 0.6)});
  player.play(500);
  player.submit({focus_at(0.001, 0.0, 0.25, 0.1), focus_at(0.081, 0.0, 0.25, 0.6)}, 2);
  player.play(600);
  // zeros are at 20 and 120 of a period; each move takes one extra sample, for both
  for (std::size_t k = 500; k < 1100; ++k) {
    EXPECT_EQ(player.at(k, 1).p_D.x(), k <= 520 ? 0.08F : 0.081F) << k;
    EXPECT_EQ(player.at(k, 0).p_D.x(), k <= 621 ? 0.0F : 0.001F) << k;
  }
  for (std::size_t k = 622; k < 1100; ++k) {
    EXPECT_NEAR(player.intensity(k, 0), 0.5 * a_of(k - 2, 0.1), 1e-6) << k;
    EXPECT_NEAR(player.intensity(k, 1), 0.5 * a_of(k - 2, 0.6), 1e-6) << k;
  }
  EXPECT_TRUE(player.watch.holds());
  EXPECT_EQ(player.emitter.stats().max_focus_step, 0.0);
  TakeOver report;
  ASSERT_TRUE(player.emitter.next_take_over(report));
  EXPECT_EQ(report.redrawn_sample, 120 + 179);  // nine tenths of a period after both have moved
  ASSERT_TRUE(player.emitter.next_take_over(report));
  EXPECT_EQ(report.first_sample, 521);
  EXPECT_EQ(report.redrawn_sample, 622 + 179);
}

TEST(FocusPhase, IsSilentFromItsZeroToTheZeroOfANewPhase) {
  Player player(settings_for(2));
  player.submit({focus_at(0.0, 0.0, 1.0), focus_at(0.08, 0.0, 1.0, 0.5)});
  player.play(450);
  player.submit({focus_at(0.0, 0.0, 1.0, 0.25), focus_at(0.08, 0.0, 1.0, 0.5)}, 2);
  player.play(600);
  // the second one's zero is at 500, the first one's at 600; each takes one extra sample
  const std::size_t rest = 601, rise = 602 + 50;
  for (std::size_t k = 502; k < 1050; ++k) {
    const double wanted = k < rest ? a_of(k - 1, 0.0) : k <= rise ? 0.0 : a_of(k - 2, 0.25);
    EXPECT_NEAR(player.intensity(k, 0), wanted, 1e-6) << k;
    if (k > rest) {
      EXPECT_NEAR(player.intensity(k, 1), a_of(k - 2, 0.5), 1e-6) << k;
    }
  }
  EXPECT_TRUE(player.watch.holds());
}

TEST(FocusPhase, ThePowerLimitHoldsWhileSomeStillPlayTheOldPlan) {
  EmitSettings settings = settings_for(2);
  settings.power_limit = 1.0;
  Player player(settings);
  player.submit({focus_at(0.0, 0.0, 1.0, 0.9), focus_at(0.08, 0.0, 0.02)});
  player.play(2 * kPeriod - 10);
  // the second becomes strong at its zero, most of a period before the first one's
  player.submit({focus_at(0.0, 0.0, 0.02, 0.9), focus_at(0.08, 0.0, 1.0)}, 2);
  player.play(4 * kPeriod);
  EXPECT_TRUE(player.watch.holds()) << player.watch.power;
  const auto peak = [&](std::size_t from, std::size_t focus) {
    double most = 0.0;
    for (std::size_t k = from; k < from + kPeriod; ++k)
      most = std::max(most, player.intensity(k, focus));
    return most;
  };
  // first the power that the first one leaves, then all
  const double loud = std::sqrt(1.0 / 1.02), low = std::sqrt(0.02 / 1.02);
  EXPECT_NEAR(peak(2 * kPeriod + 2, 1), low, 1e-6);
  EXPECT_NEAR(peak(3 * kPeriod + 2, 1), loud, 1e-6);
  EXPECT_NEAR(peak(3 * kPeriod + 2, 0), low, 1e-6);
}

TEST(FocusPhase, LossIsSilentWithinAPeriod) {
  Player player(settings_for(3));
  player.submit({focus_at(0.0, 0.0, 1.0, 0.2), focus_at(0.04, 0.0, 1.0, 0.55),
                 focus_at(0.08, 0.0, 1.0, 0.9)});
  player.play(650);
  player.emitter.lose();
  player.play(600);
  for (std::size_t k = 650 + kPeriod; k < 1250; ++k) {
    for (std::size_t f = 0; f < 3; ++f) ASSERT_EQ(player.intensity(k, f), 0.0) << k;
  }
  EXPECT_TRUE(player.watch.holds());
  // the clock restarts
  player.submit({focus_at(0.0, 0.01, 1.0, 0.5)}, 2);
  player.play(400);
  const std::size_t f = player.intensity(1450, 0) > 0.0   ? 0
                        : player.intensity(1450, 1) > 0.0 ? 1
                                                          : 2;
  for (std::size_t k = 0; k < 400; ++k) {
    EXPECT_NEAR(player.intensity(1250 + k, f), k < 100 ? 0.0 : a_of(k, 0.5), 1e-6) << k;
  }
}

TEST(FocusPhase, PhasesOutOfBoundsAreRejected) {
  Player player(settings_for(1));
  int refused = 0;
  for (const double phase : {-0.1, 1.1, std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity()}) {
    player.submit({focus_at(0.0, 0.0, 1.0, phase)});
    player.play(300);
    EXPECT_EQ(player.emitter.stats().refused_plans, ++refused);
    EXPECT_EQ(player.kept.back().intensity, 0.0F);
  }
  player.submit({focus_at(0.0, 0.0, 1.0, 1.0)});  // same as 0
  player.play(200);
  EXPECT_NEAR(player.intensity(player.kept.size() - 100), 1.0, 1e-6);
}

TEST(FocusPhase, ALoopIncludesAllFromItsFirstSample) {
  LiftedPlan plan;
  plan.foci.push_back(focus_at(0.0, 0.0, 1.0, 0.3));
  plan.foci.push_back(focus_at(0.05, 0.0, 0.25, 0.85));
  const LoopSamples loop = loop_samples(plan, settings_for(2), 40e3);
  ASSERT_EQ(loop.samples, 200);
  for (std::size_t k = 0; k < 200; ++k) {
    EXPECT_NEAR(loop.sample[2 * k].intensity, a_of(k, 0.3), 1e-6) << k;
    EXPECT_NEAR(loop.sample[2 * k + 1].intensity, 0.5 * a_of(k, 0.85), 1e-6) << k;
  }
}

/// Whether the intensities match one reading of the clock.
bool in_phase(const Player& player, const std::vector<LiftedFocus>& plan, std::size_t n,
              Waveform waveform, double full_scale) {
  const std::size_t last = player.kept.size() / player.foci - 1;
  for (std::size_t clock = 0; clock < n; ++clock) {
    bool all = true;
    for (std::size_t f = 0; f < player.foci && all; ++f) {
      const FocusSample& s = player.at(last, f);
      double wanted = 0.0;
      for (const LiftedFocus& focus : plan) {
        if (s.p_D != focus.p_D.cast<float>()) continue;
        const auto delay = static_cast<std::size_t>(std::lround(focus.phase * double(n)));
        const double turns = static_cast<double>((clock + n - delay % n) % n) / double(n);
        wanted = std::sqrt(focus.pressure / full_scale) * envelope(waveform, turns);
      }
      all = std::abs(static_cast<double>(s.intensity) - wanted) < 1e-6;
    }
    if (all) return true;
  }
  return false;
}

TEST(FocusPhase, GuaranteesHoldForAnySequenceOfPlans) {
  Random random(12);
  for (int trial = 0; trial < 40; ++trial) {
    EmitSettings settings = settings_for(1 + random.below(8));
    settings.power_limit = trial % 2 == 0 ? 8.0 : random.uniform(0.5, 3.0);
    settings.am_frequency = random.uniform(25.0, 40e3 / 126.0);
    settings.am_waveform = trial % 4 < 2 ? Waveform::RaisedCosine : Waveform::SineMagnitude;
    settings.stall_time = 10.0;
    Player player(settings);
    const auto n = static_cast<std::size_t>(player.emitter.period());
    for (int k = 0; k < 40; ++k) {
      std::vector<LiftedFocus> foci;
      if (random.uniform() < 0.1) {
        player.emitter.lose();
      } else {
        LiftedPlan& plan = player.emitter.draft();
        plan.foci.clear();
        for (int f = random.below(settings.foci + 1); f > 0; --f) {
          plan.foci.push_back(focus_at(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1),
                                       random.uniform(0.02, 1.0), random.uniform()));
        }
        foci.assign(plan.foci.begin(), plan.foci.end());
        player.emitter.submit();
      }
      player.play(1 + static_cast<std::size_t>(random.below(900)));
      if (k % 4 != 3) continue;
      // once all have moved to the new plan
      player.play(3 * n + 20);
      if (settings.power_limit == 8.0) {
        ASSERT_TRUE(in_phase(player, foci, n, settings.am_waveform, 1.0)) << trial << " " << k;
      }
    }
    ASSERT_NO_FATAL_FAILURE(expect_within_bounds(player)) << trial;
  }
}

}  // namespace
}  // namespace prostm
