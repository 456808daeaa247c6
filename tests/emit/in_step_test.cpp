// Plans in step: all focal points share the clock of one loop.
#include "prostm/emit/detail/in_step.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "emit/paths.hpp"
#include "support/heap_guard.hpp"

namespace prostm {
namespace {

using test::Player;
using test::ring;
using test::settings_for;

constexpr double kRate = 40e3, kLoop = 20e-3;  // [Hz], [s]
const Vec3 kCentre(0.0, 0.0, 0.2);

/// A ring that is traversed `laps` times in a loop.
LiftedPath turning(const Vec3& centre, double length, int laps, double loop = kLoop,
                   int sides = 40) {
  LiftedPath path = ring(centre, length, sides, 1.0);
  path.speed = path.length * laps / loop;
  return path;
}

void submit(Player& player, const std::vector<LiftedPath>& paths, double loop = kLoop,
            std::int64_t id = 1) {
  LiftedPlan& plan = player.emitter.draft();
  plan.paths.assign(paths.begin(), paths.end());
  plan.loop = loop;
  plan.id = id;
  player.emitter.submit();
}

/// The position on a path at sample k of a loop of n, by (E10).
Vec3 place_at(const LiftedPath& path, std::int64_t k, std::int64_t n, int laps) {
  return point_at(path, path.length * std::fmod(static_cast<double>(k) * laps / double(n), 1.0))
      .p_D;
}

/// Distance between a focal point at a sample and that position [m].
double off(const Player& player, std::size_t foci, std::int64_t sample, std::size_t focus,
           const Vec3& place) {
  const FocusSample& s = player.kept[static_cast<std::size_t>(sample) * foci + focus];
  return (s.p_D.cast<double>() - place).norm();
}

TEST(InStep, FocalPointsThatStartFromSilenceFollowOneClock) {
  const LiftedPath a = turning(kCentre, 0.140, 1), b = turning(kCentre + Vec3(0.06, 0, 0), 0.06, 2),
                   c = turning(kCentre + Vec3(0.12, 0, 0), 0.04, 3);
  Player player(settings_for(3));
  player.keep = true;
  submit(player, {a, b, c});
  player.play(60);
  for (std::int64_t k = 0; k < 2400; ++k) {
    ASSERT_LT(off(player, 3, k, 0, place_at(a, k, 800, 1)), 1e-7) << k;
    ASSERT_LT(off(player, 3, k, 1, place_at(b, k, 800, 2)), 1e-7) << k;
    ASSERT_LT(off(player, 3, k, 2, place_at(c, k, 800, 3)), 1e-7) << k;
  }
  EXPECT_EQ(player.kept[0].intensity, 0.0F);
  EXPECT_EQ(player.kept[3 * 40].intensity, 1.0F);
  EXPECT_EQ(player.emitter.stats().laps_started, 3 + 6 + 9);
  EXPECT_EQ(player.emitter.stats().laps_cut, 0);
  TakeOver report;
  ASSERT_FALSE(player.emitter.next_take_over(report) && report.redrawn_sample < 700);
  EXPECT_TRUE(player.watch.holds());
}

TEST(InStep, ANewPlanStartsAtTheEndOfTheLoopAndKeepsThePhase) {
  LiftedPath a = turning(kCentre, 0.130, 1), b = turning(kCentre + Vec3(0.06, 0, 0), 0.06, 2);
  Player player(settings_for(2));
  player.keep = true;
  submit(player, {a, b});
  player.play(10);  // 400 samples: b has finished a lap, but the loop continues to 800
  const Vec3 drift(0.0, 2e-3, 1e-3);
  const LiftedPath c = turning(kCentre + drift, 0.125, 1),
                   d = turning(kCentre + Vec3(0.06, 0, 0) + drift, 0.065, 2);
  submit(player, {d, c});  // in another order
  player.play(70);
  for (std::int64_t k = 0; k < 3200; ++k) {
    const bool old = k <= 800;
    if (k > 800 && k < 960) continue;  // the offset closes
    ASSERT_LT(off(player, 2, k, 0, place_at(old ? a : c, k, 800, 1)), 1e-6) << k;
    ASSERT_LT(off(player, 2, k, 1, place_at(old ? b : d, k, 800, 2)), 1e-6) << k;
  }
  EXPECT_EQ(player.emitter.stats().faded, 2 * 40);  // only the first rise
  EXPECT_EQ(player.emitter.stats().laps_cut, 0);
  EXPECT_TRUE(player.watch.holds()) << player.watch.step;
}

TEST(InStep, StartsAtTheNextBlockIfRequestedAndInPhaseToo) {
  EmitSettings settings = settings_for(1);
  settings.switch_at = SwitchAt::Now;
  Player player(settings);
  player.keep = true;
  submit(player, {turning(kCentre, 0.130, 1)});
  player.play(7);
  const LiftedPath next = turning(kCentre + Vec3(2e-3, 0, 0), 0.130, 1);
  submit(player, {next});
  player.play(20);
  for (std::int64_t k = 280 + 120; k < 1080; ++k) {
    ASSERT_LT(off(player, 1, k, 0, place_at(next, k, 800, 1)), 1e-6) << k;
  }
  EXPECT_EQ(player.emitter.stats().faded, 40);
  // a loop of another length starts there
  const LiftedPath other = turning(kCentre + Vec3(2e-3, 0, 0), 0.065, 1, 10e-3);
  submit(player, {other}, 10e-3);
  player.play(40);
  for (std::int64_t k = 1079 + 1600 - 400; k < 1079 + 1600; ++k) {
    ASSERT_LT(off(player, 1, k, 0, place_at(other, k - 1079, 400, 1)), 1e-6) << k;
  }
  EXPECT_TRUE(player.watch.holds()) << player.watch.step;
}

TEST(InStep, ALoopOfAnotherLengthStartsWhenTheCurrentOneEnds) {
  Player player(settings_for(2));
  player.keep = true;
  const LiftedPath a = turning(kCentre, 0.130, 1), b = turning(kCentre + Vec3(0.07, 0, 0), 0.06, 2);
  submit(player, {a, b});
  player.play(25);
  const LiftedPath c = turning(kCentre, 0.060, 1, 10e-3),
                   d = turning(kCentre + Vec3(0.07, 0, 0), 0.05, 1, 10e-3);
  submit(player, {c, d}, 10e-3);
  player.play(60);
  for (std::int64_t k = 0; k <= 1600; ++k) {
    ASSERT_LT(off(player, 2, k, 0, place_at(a, k, 800, 1)), 1e-6) << k;
  }
  for (std::int64_t k = 1600 + 400; k < 3400; ++k) {
    ASSERT_LT(off(player, 2, k, 0, place_at(c, k - 1600, 400, 1)), 1e-6) << k;
    ASSERT_LT(off(player, 2, k, 1, place_at(d, k - 1600, 400, 1)), 1e-6) << k;
  }
  EXPECT_TRUE(player.watch.holds()) << player.watch.step;
}

TEST(InStep, ADistantPathIsReachedInSilenceAtTheClocksPosition) {
  Player player(settings_for(1));
  player.keep = true;
  submit(player, {turning(kCentre, 0.130, 1)});
  player.play(10);
  const LiftedPath far = turning(kCentre + Vec3(0.1, 0, 0), 0.130, 1);
  submit(player, {far});
  player.play(50);
  for (std::int64_t k = 41; k <= 800; ++k) {
    ASSERT_EQ(player.kept[static_cast<std::size_t>(k)].intensity, 1.0F) << k;
  }
  EXPECT_EQ(player.kept[840].intensity, 0.0F);
  for (std::int64_t k = 841; k < 2400; ++k) {
    ASSERT_LT(off(player, 1, k, 0, place_at(far, k, 800, 1)), 1e-6) << k;
  }
  EXPECT_EQ(player.emitter.stats().faded, 40 + 80);
  EXPECT_TRUE(player.watch.holds());
}

TEST(InStep, LateOrResumingFocalPointsStartInPhase) {
  const LiftedPath a = turning(kCentre, 0.130, 1), b = turning(kCentre + Vec3(0.07, 0, 0), 0.06, 2);
  Player player(settings_for(2));
  player.keep = true;
  submit(player, {a});  // the second focal point takes it
  player.play(7);
  submit(player, {a, b});  // the first one is idle, so there is no need to wait
  player.play(33);
  submit(player, {a});
  player.play(40);
  submit(player, {a, b});
  player.play(40);
  for (std::int64_t k = 0; k < 4800; ++k) {
    ASSERT_LT(off(player, 2, k, 1, place_at(a, k, 800, 1)), 1e-6) << k;
    if ((k >= 280 && k <= 1600) || k >= 3200) {
      ASSERT_LT(off(player, 2, k, 0, place_at(b, k, 800, 2)), 1e-6) << k;
    }
  }
  // after a silence the loop restarts
  player.emitter.lose();
  player.play(23);
  const std::int64_t start = player.samples();
  submit(player, {b, a});
  player.play(40);
  for (std::int64_t k = 0; k < 1600; ++k) {
    ASSERT_LT(off(player, 2, start + k, 0, place_at(b, k, 800, 2)), 1e-6) << k;
    ASSERT_LT(off(player, 2, start + k, 1, place_at(a, k, 800, 1)), 1e-6) << k;
  }
  EXPECT_TRUE(player.watch.holds());
}

TEST(InStep, TheMatchingUsesThePositionsAtTheClock) {
  // two concentric rings that start at opposite sides; then each is rotated by half a lap
  LiftedPath a = turning(kCentre, 0.130, 1), b = a;
  std::rotate(b.p_D.begin(), b.p_D.begin() + 20, b.p_D.end());
  measure(b);
  for (const SwitchAt when : {SwitchAt::Lap, SwitchAt::Now}) {
    EmitSettings settings = settings_for(2);
    settings.switch_at = when;
    Player player(settings);
    player.keep = true;
    submit(player, {a, b});
    player.play(30);         // a lap and a half
    submit(player, {b, a});  // the same positions, so nothing changes
    player.play(60);
    EXPECT_EQ(player.emitter.stats().faded, 2 * 40);
    for (std::int64_t k = 0; k < 3600; ++k) {
      ASSERT_LT(off(player, 2, k, 0, place_at(a, k, 800, 1)), 1e-6) << k;
    }
  }
}

TEST(InStep, APathTooLongForTheLoopTakesSeveralLoops) {
  const LiftedPath slow = turning(kCentre, 0.190, 1),  // 9.5 m/s
      fast = turning(kCentre + Vec3(0.08, 0, 0), 0.06, 2);
  Player player(settings_for(2));
  player.keep = true;
  submit(player, {slow, fast});
  player.play(85);
  for (std::int64_t k = 0; k < 3400; ++k) {
    ASSERT_LT(off(player, 2, k, 0, place_at(slow, k, 1600, 1)), 1e-6) << k;
    ASSERT_LT(off(player, 2, k, 1, place_at(fast, k, 1600, 4)), 1e-6) << k;
  }
  // but a plan can start after each loop
  submit(player, {fast});
  player.play(60);
  EXPECT_EQ(player.kept[2 * 4000].intensity, 1.0F);
  EXPECT_LT(player.kept[2 * 4001].intensity, 1.0F);
  EXPECT_TRUE(player.watch.holds()) << player.watch.step;
}

TEST(InStep, LoopsOutOfBoundsAreRejected) {
  Player player(settings_for(1));
  int refused = 0;
  for (const double loop : {-0.02, 0.9e-3, 1.1, std::numeric_limits<double>::infinity(),
                            std::numeric_limits<double>::quiet_NaN()}) {
    submit(player, {turning(kCentre, 0.130, 1)}, loop);
    player.play(20);
    EXPECT_EQ(player.emitter.stats().refused_plans, ++refused);
  }
}

/// A plan with its laps, for a random sequence.
struct Played {
  std::vector<LiftedPath> paths;
  std::vector<int> laps;
  double loop = 0.0;
};

Played random_plan(Random& random, double drift, double loop) {
  Played plan;
  plan.loop = loop;
  for (int p = 0; p < 4; ++p) {
    if (random.uniform() < 0.1) continue;
    const Vec3 centre = kCentre + Vec3(0.05 * (p % 2), 0.05 * (p / 2), 0.0) +
                        drift * Vec3(random.normal(), random.normal(), random.normal());
    const double longest = loop > 0.0 ? 7.8 * loop : 0.14;  // so that a lap fits into a loop
    const double length = random.uniform(0.02, std::min(0.14, longest));
    const double fits = loop > 0.0 ? longest / length : 1.0;
    const int laps = std::max(1, std::min(1 + random.below(4), static_cast<int>(fits)));
    LiftedPath path = turning(centre, length, laps, loop > 0.0 ? loop : kLoop);
    if (loop == 0.0) path.speed = 7.0;
    if (random.uniform() < 0.1) path = test::point(centre, 1.0);
    for (double& p_i : path.pressure) p_i = random.uniform(0.5, 1.0);
    plan.paths.push_back(path);
    plan.laps.push_back(laps);
  }
  return plan;
}

/// Whether all active focal points are at the position of one reading of the clock.
bool in_step(const Played& plan, std::int64_t n, std::span<const FocusSample> sample,
             std::int64_t count) {
  return std::all_of(sample.begin(), sample.end(), [&](const FocusSample& s) {
    if (s.intensity == 0.0F) return true;
    for (std::size_t p = 0; p < plan.paths.size(); ++p) {
      const Vec3 place = place_at(plan.paths[p], count, n, plan.laps[p]);
      if ((s.p_D.cast<double>() - place).norm() < 1e-6) return true;
    }
    return false;
  });
}

/// Finds a reading at which all are in step; −1 without one.
std::int64_t find_count(const Played& plan, std::int64_t n, std::span<const FocusSample> sample) {
  for (std::int64_t count = 0; count < n; ++count) {
    if (in_step(plan, n, sample, count)) return count;
  }
  return -1;
}

TEST(InStep, PhasesAreExactAfterAnySequenceOfPlans) {
  int checked = 0;
  for (int round = 0; round < 60; ++round) {
    Random random(static_cast<std::uint64_t>(round));
    EmitSettings settings = settings_for(4);
    settings.switch_at = round % 3 == 0 ? SwitchAt::Now : SwitchAt::Lap;
    settings.power_limit = round % 2 == 0 ? 4.0 : 2.0;
    const double rate = round % 5 == 4 ? random.uniform(8e3, 60e3) : kRate;
    const double drift = round % 4 == 0 ? 0.05 : 2e-3;
    const bool mixed = round % 2 == 1;
    Player player(settings, rate);
    const int rest = static_cast<int>(rate * 0.06) / 40;  // an offset closes in 20 ms
    for (int k = 0; k < 12; ++k) {
      const double loops[] = {20e-3, 20e-3, 20e-3, 10e-3, 5e-3, 0.0};
      Played plan;
      for (int quick = 1 + random.below(3); quick > 0; --quick) {
        plan = random_plan(random, drift, loops[mixed ? random.below(6) : random.below(3)]);
        submit(player, plan.paths, plan.loop);
        if (random.uniform() < 0.1) player.emitter.lose();
        player.play(1 + random.below(30));
      }
      submit(player, plan.paths, plan.loop);
      player.play(rest);
      if (plan.loop == 0.0 || plan.paths.empty()) continue;
      const auto n = static_cast<std::int64_t>(std::ceil(plan.loop * rate - 1e-6));
      const auto last = player.play(1);
      const auto first = last.first(4);
      const std::int64_t count = find_count(plan, n, first);
      ASSERT_GE(count, 0) << "round " << round << ", plan " << k;
      for (std::int64_t i = 0; i < 40; ++i) {
        const auto sample = last.subspan(4 * static_cast<std::size_t>(i), 4);
        ASSERT_TRUE(in_step(plan, n, sample, count + i)) << "round " << round << ", plan " << k;
      }
      ++checked;
    }
    ASSERT_TRUE(player.watch.holds())
        << "round " << round << ": step " << player.watch.step << " m, slew " << player.watch.slew
        << ", power " << player.watch.power;
  }
  EXPECT_GT(checked, 400);
}

TEST(InStep, TheClockContinuesAcrossPlans) {
  // 200 plans of 20 ms at arbitrary times: one sample count from the first to the last
  Random random(3);
  Player player(settings_for(4));
  Played plan = random_plan(random, 2e-3, kLoop);
  submit(player, plan.paths);
  for (int k = 0; k < 200; ++k) {
    player.play(1 + random.below(50));
    plan = random_plan(random, k % 10 == 0 ? 0.03 : 1e-3, kLoop);
    submit(player, plan.paths);
  }
  player.play(60);
  const std::int64_t now = player.samples();
  const auto last = player.play(1);
  for (std::int64_t i = 0; i < 40; ++i) {
    EXPECT_TRUE(in_step(plan, 800, last.subspan(4 * static_cast<std::size_t>(i), 4), now + i));
  }
  EXPECT_TRUE(player.watch.holds());
}

TEST(InStep, DoesNotAllocate) {
  Player player(settings_for(8));
  Random random(9);
  const Played plan = random_plan(random, 0.01, kLoop), other = random_plan(random, 0.01, 10e-3);
  LiftedPlan &draft = player.emitter.draft(), lifted[2];
  lifted[0].paths.assign(plan.paths.begin(), plan.paths.end());
  lifted[0].loop = plan.loop;
  lifted[1].paths.assign(other.paths.begin(), other.paths.end());
  lifted[1].loop = other.loop;
  draft = lifted[0];
  const test::HeapGuard guard;
  for (int k = 0; k < 20; ++k) {
    player.emitter.draft() = lifted[k % 3 == 2 ? 1 : 0];
    player.emitter.submit();
    player.play(25);
    if (k % 5 == 4) player.emitter.lose();
    player.play(5);
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace prostm
