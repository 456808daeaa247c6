#include "prostm/emit/detail/path_emitter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <thread>
#include <utility>

#include "emit/paths.hpp"
#include "support/heap_guard.hpp"

namespace prostm {
namespace {

using test::Player;
using test::point;
using test::ring;
using test::settings_for;

const Vec3 kCentre(0.0, 0.0, 0.2);

double distance(const FocusSample& a, const FocusSample& b) {
  return (a.p_D.cast<double>() - b.p_D.cast<double>()).norm();
}

TEST(PathEmitter, ThePapersLoopTakes800SamplesOf175Micrometres) {
  Player player(settings_for(1));
  player.keep = true;
  player.submit({ring(kCentre, 0.140, 100, 1.0)});
  player.play(60);
  const auto& kept = player.kept;
  ASSERT_EQ(kept.size(), 2400u);
  EXPECT_EQ(kept[0].intensity, 0.0F);
  EXPECT_EQ(kept[40].intensity, 1.0F);  // the rise takes 40 samples
  for (std::size_t i = 0; i + 800 < kept.size(); ++i) {
    // exactly the same position one lap later; the corners shorten steps of 0.175 mm slightly
    EXPECT_EQ(kept[i].p_D, kept[i + 800].p_D);
    EXPECT_NEAR(distance(kept[i], kept[i + 1]), 0.175e-3, 0.3e-6);
  }
  const EmitStats stats = player.emitter.stats();
  EXPECT_EQ(stats.samples, 2400);
  EXPECT_EQ(stats.laps_started, 3);
  EXPECT_EQ(stats.laps_cut, 0);
  EXPECT_EQ(stats.faded, 40);
  EXPECT_NEAR(stats.max_focus_step, 0.175e-3, 0.1e-6);
  EXPECT_TRUE(player.watch.holds());
}

TEST(PathEmitter, BlocksOfAnyLengthGiveTheSameSamples) {
  const LiftedPath path = ring(kCentre, 0.123, 37, 0.7);
  Player player(settings_for(1));
  player.keep = true;
  player.submit({path});
  player.play(50);

  PathEmitter other(settings_for(1), 40e3);
  other.draft().paths.push_back(path);
  other.submit();
  std::vector<FocusSample> samples(2000);
  std::size_t at = 0;
  for (std::size_t n = 1; at < samples.size(); n = n * 2 + 1) {
    n = std::min(n, samples.size() - at);
    other.fill(static_cast<std::int64_t>(at), std::span(samples).subspan(at, n));
    at += n;
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(samples[i].p_D, player.kept[i].p_D);
    EXPECT_EQ(samples[i].intensity, player.kept[i].intensity);
  }
}

TEST(PathEmitter, ThePressureAlongThePathIsPlayed) {
  LiftedPath path = ring(kCentre, 0.140, 100, 0.0);
  for (std::size_t i = 0; i < path.pressure.size(); ++i) {
    path.pressure[i] = 3.0 + 2.0 * std::cos(2.0 * kPi * static_cast<double>(i) / 100.0);
  }
  Player player(settings_for(1, 8.0));
  player.submit({path});
  player.keep = true;
  player.play(40);
  for (std::size_t i = 200; i < player.kept.size(); ++i) {
    const FocusSample& s = player.kept[i];
    const double pressure = point_at(path, nearest_place(path, s.p_D.cast<double>()).s).pressure;
    const double intensity = static_cast<double>(s.intensity);
    EXPECT_NEAR(8.0 * intensity * intensity, pressure, 0.01);
  }
  EXPECT_EQ(player.emitter.stats().saturated, 0);

  // at a full scale of 4 the maximum is clipped and counted
  Player loud(settings_for(1, 4.0));
  loud.submit({path});
  loud.play(20);
  const std::int64_t saturated = loud.emitter.stats().saturated;
  // 3 + 2 cos a > 4 on a third of the lap
  EXPECT_NEAR(static_cast<double>(saturated), 800.0 / 3.0, 4.0);
}

TEST(PathEmitter, ADriftingPathIsFollowedWithoutAFade) {
  Player player(settings_for(2));
  player.submit({ring(kCentre, 0.140, 50, 1.0), ring(kCentre + Vec3(0.06, 0, 0), 0.1, 50, 0.8)});
  player.play(40);
  const std::int64_t faded = player.emitter.stats().faded;
  EXPECT_EQ(faded, 2 * 40 - 4);  // the rise to sqrt(0.8) takes 36 samples
  for (int k = 1; k <= 50; ++k) {
    const Vec3 drift(0.0, 0.003 * k, 0.001 * k);
    player.submit({ring(kCentre + drift, 0.140, 50, 1.0),
                   ring(kCentre + Vec3(0.06, 0, 0) + drift, 0.1, 50, 0.8)});
    player.play(40);
  }
  EXPECT_EQ(player.emitter.stats().faded, faded);
  EXPECT_EQ(player.emitter.stats().laps_cut, 0);
  EXPECT_TRUE(player.watch.holds()) << player.watch.step;
}

TEST(PathEmitter, ADistantPathIsReachedInSilenceAtTheEndOfTheLap) {
  Player player(settings_for(1));
  player.keep = true;
  player.submit({ring(kCentre, 0.140, 50, 1.0)}, 1);
  player.play(10);
  player.submit({ring(kCentre + Vec3(0.1, 0, 0), 0.140, 50, 1.0)}, 2);
  player.play(60);
  // full until the lap of 800 samples ends, silent 40 samples later, then one silent sample, and
  // full again after another 40
  const auto& kept = player.kept;
  for (std::size_t i = 41; i <= 800; ++i) ASSERT_EQ(kept[i].intensity, 1.0F) << i;
  EXPECT_LT(kept[801].intensity, 1.0F);
  EXPECT_EQ(kept[840].intensity, 0.0F);
  EXPECT_EQ(kept[841].intensity, 0.0F);
  EXPECT_GT(distance(kept[840], kept[841]), 0.04);
  EXPECT_EQ(kept[881].intensity, 1.0F);
  EXPECT_EQ(player.emitter.stats().faded, 40 + 80);
  EXPECT_EQ(player.emitter.stats().laps_cut, 0);
  EXPECT_TRUE(player.watch.holds());

  TakeOver first, second;
  ASSERT_TRUE(player.emitter.next_take_over(first));
  EXPECT_EQ(first.plan, 1);
  EXPECT_EQ(first.first_sample, 0);
  EXPECT_NEAR(static_cast<double>(first.redrawn_sample), 40 + 720, 2.0);
  ASSERT_TRUE(player.emitter.next_take_over(second));
  EXPECT_EQ(second.plan, 2);
  EXPECT_EQ(second.arrival_sample, 400);
  EXPECT_EQ(second.first_sample, 841);
  EXPECT_NEAR(static_cast<double>(second.redrawn_sample), 881 + 720, 2.0);
  EXPECT_FALSE(player.emitter.next_take_over(second));
}

TEST(PathEmitter, SwitchNowStartsThePlanAtTheNextBlock) {
  EmitSettings settings = settings_for(1);
  settings.switch_at = SwitchAt::Now;
  Player player(settings);
  player.submit({ring(kCentre, 0.140, 50, 1.0)}, 1);
  player.play(10);
  player.submit({ring(kCentre + Vec3(0.1, 0, 0), 0.140, 50, 1.0)}, 2);
  player.play(1);
  EXPECT_EQ(player.emitter.stats().laps_cut, 1);
  player.play(39);
  TakeOver report;
  ASSERT_TRUE(player.emitter.next_take_over(report));
  EXPECT_EQ(report.plan, 1);
  EXPECT_EQ(report.redrawn_sample, -1);  // cut off after 400 of 800 samples
  ASSERT_TRUE(player.emitter.next_take_over(report));
  EXPECT_EQ(report.plan, 2);
  EXPECT_EQ(report.first_sample, 440);
  EXPECT_TRUE(player.watch.holds());
}

TEST(PathEmitter, VerySlowLapsAreInterrupted) {
  Player player(settings_for(1));
  player.submit({ring(kCentre, 0.140, 50, 1.0, 1e-3)});
  player.play(40);
  const LiftedPath next = ring(kCentre + Vec3(0.002, 0, 0), 0.140, 50, 1.0);
  player.submit({next});
  const auto last = player.play(10);
  EXPECT_LT(nearest_place(next, last[39].p_D.cast<double>()).distance, 1e-6);
  EXPECT_EQ(player.emitter.stats().laps_cut, 1);
}

TEST(PathEmitter, ANewPathIsTraversedInTheDirectionOfTravel) {
  LiftedPath forth = ring(kCentre, 0.140, 50, 1.0), back = forth;
  std::reverse(back.p_D.begin(), back.p_D.end());
  measure(back);
  Player player(settings_for(1));
  player.keep = true;
  player.submit({forth});
  player.play(20);
  player.submit({back});
  player.play(40);
  // a circle in the opposite direction makes no difference
  for (std::size_t i = 41; i + 800 < player.kept.size(); ++i) {
    EXPECT_LT(distance(player.kept[i], player.kept[i + 800]), 1e-6);
  }
}

/// Returns the smallest and largest distance of the first two focal points while both are active.
std::pair<double, double> distances(const Player& player, std::size_t foci, std::size_t from = 0) {
  std::pair<double, double> out(std::numeric_limits<double>::max(), 0.0);
  for (std::size_t i = from * foci; i < player.kept.size(); i += foci) {
    const FocusSample &a = player.kept[i], &b = player.kept[i + 1];
    if (std::min(a.intensity, b.intensity) < 0.01F) continue;
    out.first = std::min(out.first, distance(a, b));
    out.second = std::max(out.second, distance(a, b));
  }
  return out;
}

TEST(PathEmitter, FocalPointsStartFromSilenceAtTheFirstPoints) {
  const double apart = 0.05;
  const LiftedPath a = ring(kCentre, 0.140, 50, 1.0),
                   b = ring(kCentre + Vec3(apart, 0, 0), 0.140, 50, 1.0);
  Player player(settings_for(2));
  player.keep = true;
  player.submit({a, b});
  player.play(100);
  EXPECT_EQ(player.kept[0].p_D, a.p_D[0].cast<float>());
  // the planned distance is preserved
  EXPECT_NEAR(distances(player, 2).first, apart, 1e-6);
  EXPECT_NEAR(distances(player, 2).second, apart, 1e-6);

  // even if other positions would be farther apart
  LiftedPath turned = b;
  std::rotate(turned.p_D.begin(), turned.p_D.begin() + 20, turned.p_D.end());
  Player plain(settings_for(2));
  plain.keep = true;
  plain.submit({a, turned});
  plain.play(1);
  EXPECT_EQ(plain.kept[0].p_D, a.p_D[0].cast<float>());
  EXPECT_EQ(plain.kept[1].p_D, turned.p_D[0].cast<float>());

  // likewise after a loss, wherever the focal points rest
  player.emitter.lose();
  player.play(50);
  const std::size_t silent = player.kept.size() / 2;
  player.submit({ring(kCentre + Vec3(0, 0.04, 0), 0.140, 50, 1.0),
                 ring(kCentre + Vec3(apart, 0.04, 0), 0.140, 50, 1.0)});
  player.play(100);
  EXPECT_NEAR(distances(player, 2, silent).first, apart, 1e-6);
  EXPECT_NEAR(distances(player, 2, silent).second, apart, 1e-6);
  EXPECT_TRUE(player.watch.holds());
}

TEST(PathEmitter, AFocalPointStartsAwayFromTheActiveOnes) {
  // a second ring appears at some time in the first one's lap
  const double radius = 0.140 / (2.0 * kPi);
  const LiftedPath a = ring(kCentre, 0.140, 50, 1.0);
  for (const double apart : {0.055, 0.0}) {
    const double outline = apart > 0.0 ? 0.140 : 0.060;
    LiftedPath b = ring(kCentre + Vec3(apart, 0, 0), outline, 50, 1.0, 7.0 * outline / 0.140);
    for (int blocks = 3; blocks < 23; ++blocks) {
      Player player(settings_for(2));
      player.keep = true;
      player.submit({a});
      player.play(blocks);
      player.submit({a, b});
      player.play(140);
      // the largest distance is that of the centres for two equal rings, and that of opposite sides
      // for a ring inside another, each to half of a 32nd of a lap
      const double best = apart > 0.0 ? apart : radius + outline / (2.0 * kPi);
      const double off = 2.0 * radius * std::sin(kPi / 64.0);
      EXPECT_GT(distances(player, 2).first, best - off) << blocks;
      EXPECT_TRUE(player.watch.holds());
    }
  }
}

TEST(PathEmitter, EachFocalPointKeepsToItsNeighbourhood) {
  // the same four rings in every order: no focal point needs to jump
  std::array<LiftedPath, 4> rings;
  for (std::size_t i = 0; i < 4; ++i) {
    rings[i] = ring(kCentre + Vec3(0.05 * static_cast<double>(i), 0, 0), 0.1, 30, 1.0);
  }
  Player player(settings_for(4));
  player.submit({rings[0], rings[1], rings[2], rings[3]});
  player.play(40);
  player.submit({rings[2], rings[0], rings[3], rings[1]});
  player.play(40);
  player.submit({rings[3], rings[2], rings[1], rings[0]});
  player.play(40);
  EXPECT_EQ(player.emitter.stats().faded, 4 * 40);
}

TEST(PathEmitter, TheNumberOfPathsMayChange) {
  Player player(settings_for(4));
  const LiftedPath a = ring(kCentre, 0.140, 50, 1.0),
                   b = ring(kCentre + Vec3(0.08, 0, 0), 0.1, 50, 1.0);
  player.submit({a});
  auto last = player.play(40);
  EXPECT_EQ(last[0].intensity + last[1].intensity + last[2].intensity + last[3].intensity, 1.0F);
  player.submit({b, a});
  last = player.play(40);
  EXPECT_EQ(last[0].intensity + last[1].intensity + last[2].intensity + last[3].intensity, 2.0F);
  player.submit({b});
  last = player.play(40);
  EXPECT_EQ(last[0].intensity + last[1].intensity + last[2].intensity + last[3].intensity, 1.0F);
  // idle focal points do not move
  std::vector<FocusSample> before(last.begin(), last.end());
  last = player.play(5);
  int resting = 0;
  for (std::size_t f = 0; f < 4; ++f) resting += distance(before[f], last[f]) == 0.0 ? 1 : 0;
  EXPECT_EQ(resting, 3);
  // five paths for four focal points: one path is dropped and counted
  player.submit({a, b, a, b, a});
  player.play(40);
  EXPECT_EQ(player.emitter.stats().dropped_paths, 1);
  player.submit({});
  last = player.play(40);
  for (std::size_t f = 0; f < 4; ++f) EXPECT_EQ(last[f].intensity, 0.0F);
  EXPECT_TRUE(player.watch.holds());
}

TEST(PathEmitter, ALossFadesWithin50Milliseconds) {
  Player player(settings_for(2));
  player.submit({ring(kCentre, 0.140, 50, 1.0), point(kCentre + Vec3(0.05, 0, 0), 1.0)});
  player.play(10);
  player.emitter.lose();
  const auto during = player.play(5);
  EXPECT_GT(during[0].intensity, 0.3F);  // a fade of 10 ms, not a cut
  const auto after = player.play(6);
  for (const FocusSample& s : after.last(2)) EXPECT_EQ(s.intensity, 0.0F);
  EXPECT_EQ(player.emitter.stats().laps_cut, 1);
  EXPECT_EQ(player.emitter.stats().stalls, 0);
  player.play(200);
  EXPECT_EQ(player.emitter.stats().stalls, 0);
  // the next plan resumes the output
  player.submit({ring(kCentre, 0.140, 50, 1.0)});
  const auto back = player.play(3);
  EXPECT_EQ(back[back.size() - 2].intensity + back[back.size() - 1].intensity, 1.0F);
  EXPECT_TRUE(player.watch.holds());
}

TEST(PathEmitter, IsSilentWhileMutedAndResumesWithTheNextPlan) {
  const auto mute = std::make_shared<Mute>();
  Player player(settings_for(2));
  player.emitter.obey(mute);
  const auto submit = [&] {
    player.submit({ring(kCentre, 0.140, 50, 1.0), point(kCentre + Vec3(0.05, 0, 0), 1.0)});
  };
  const auto silent = [](std::span<const FocusSample> samples) {
    return std::all_of(samples.begin(), samples.end(),
                       [](const FocusSample& s) { return s.intensity == 0.0F; });
  };
  submit();
  EXPECT_FALSE(silent(player.play(10)));
  mute->set(MuteReason::Calibration, true);
  mute->set(MuteReason::NoHand, true);
  EXPECT_GT(player.play(5)[0].intensity, 0.3F);  // a fade of 10 ms, not a cut
  player.play(6);
  for (int i = 0; i < 100; ++i) {
    if (i % 40 == 0) submit();
    // one reason mutes like two; no stall is counted
    mute->set(MuteReason::NoHand, i < 50);
    ASSERT_TRUE(silent(player.play(1))) << i;
  }
  mute->set(MuteReason::Calibration, false);
  EXPECT_TRUE(silent(player.play(10))) << "the earlier plan is dropped";
  submit();
  EXPECT_FALSE(silent(player.play(3)));
  EXPECT_EQ(player.emitter.stats().stalls, 0);
  EXPECT_EQ(player.emitter.stats().refused_plans, 0);
  EXPECT_TRUE(player.watch.holds());
}

TEST(PathEmitter, AStallFadesAfter100Milliseconds) {
  Player player(settings_for(1));
  player.keep = true;
  player.submit({ring(kCentre, 0.140, 50, 1.0)});
  player.play(150);
  for (std::size_t i = 40; i < 4000; ++i) ASSERT_EQ(player.kept[i].intensity, 1.0F);
  EXPECT_LT(player.kept[4001].intensity, 1.0F);
  EXPECT_GT(player.kept[4200].intensity, 0.4F);
  EXPECT_EQ(player.kept[4402].intensity, 0.0F);
  EXPECT_EQ(player.emitter.stats().stalls, 1);
  EXPECT_TRUE(player.watch.holds());
}

TEST(PathEmitter, InvalidNumbersAreNeverEmitted) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  const LiftedPath good = ring(kCentre, 0.140, 50, 1.0);
  std::vector<LiftedPath> bad(7, good);
  bad[0].p_D[3].y() = nan;
  bad[1].p_D[0].x() = infinite;
  bad[2].pressure[10] = nan;
  bad[3].pressure[10] = infinite;
  bad[4].speed = nan;
  bad[5].p_D[0].z() = 1e200;
  bad[6].pressure.pop_back();
  Player player(settings_for(2));
  std::int64_t refused = 0;
  for (const LiftedPath& path : bad) {
    player.submit({good, good});
    player.play(30);
    player.submit({good, path});
    const auto last = player.play(50);
    EXPECT_EQ(player.emitter.stats().refused_plans, ++refused);
    for (const FocusSample& s : last) EXPECT_EQ(s.intensity, 0.0F);
  }
  EXPECT_TRUE(player.watch.holds());
  // wrong arc lengths are recomputed
  LiftedPath lying = good;
  lying.length = nan;
  for (double& s : lying.s) s = -1e300;
  player.submit({lying});
  player.play(60);
  EXPECT_EQ(player.emitter.stats().refused_plans, refused);
  EXPECT_TRUE(player.watch.holds());
}

TEST(PathEmitter, ThePowerLimitScalesAllFociAlike) {
  EmitSettings settings = settings_for(4);
  settings.power_limit = 1.0;
  Player player(settings);
  player.submit({ring(kCentre, 0.14, 50, 1.0), ring(kCentre, 0.13, 50, 1.0), point(kCentre, 0.25),
                 point(kCentre, 0.25)});
  const auto last = player.play(10);
  const double scale = 1.0 / std::sqrt(2.5);
  float sum = 0.0F;
  for (const FocusSample& s : last.last(4)) sum += s.intensity;
  EXPECT_NEAR(static_cast<double>(sum), 3.0 * scale, 1e-6);
  EXPECT_GT(player.emitter.stats().limited, 0);
  EXPECT_TRUE(player.watch.holds());
}

/// Returns a random plan: points, tiny, ordinary and long loops, anywhere within 20 cm.
LiftedPlan random_plan(Random& random, double near) {
  LiftedPlan plan;
  const int paths = random.below(kMaxPaths + 1);
  for (int p = 0; p < paths; ++p) {
    LiftedPath path;
    const int points = random.uniform() < 0.1 ? 1 : 1 + random.below(kMaxLiftedPoints / 4);
    const double size = std::pow(10.0, random.uniform(-7.0, -1.0));
    const Vec3 centre = kCentre + near * Vec3(random.normal(), random.normal(), random.normal());
    for (int i = 0; i < points; ++i) {
      path.p_D.push_back(centre + size * Vec3(random.normal(), random.normal(), random.normal()));
      path.pressure.push_back(random.uniform(-0.1, 1.3));
    }
    path.speed = random.uniform() < 0.8 ? 7.0 : random.uniform(0.0, 30.0);
    plan.paths.push_back(path);
  }
  return plan;
}

TEST(PathEmitter, GuaranteesHoldForAnySequenceOfPlans) {
#ifdef PROSTM_SANITIZED
  constexpr int kRounds = 5, kBlocks = 1000;
#else
  constexpr int kRounds = 50, kBlocks = 2000;  // 10⁵ blocks
#endif
  for (int round = 0; round < kRounds; ++round) {
    Random random(static_cast<std::uint64_t>(round));
    EmitSettings settings = settings_for(1 + random.below(8));
    settings.switch_at = random.uniform() < 0.5 ? SwitchAt::Lap : SwitchAt::Now;
    settings.power_limit = random.uniform() < 0.5 ? 4.0 : random.uniform(0.1, 3.0);
    const double rate = random.uniform() < 0.7 ? 40e3 : random.uniform(1e3, 80e3);
    const double near = std::pow(10.0, random.uniform(-4.0, -0.7));
    const double often = random.uniform(0.005, 0.5);
    Player player(settings, rate);
    TakeOver report;
    for (int block = 0; block < kBlocks; ++block) {
      if (random.uniform() < often) {
        player.emitter.draft() = random_plan(random, near);
        player.emitter.draft().id = block;
        player.emitter.submit();
      }
      if (random.uniform() < 0.01) player.emitter.lose();
      if (random.uniform() < 0.01) player.play(100);
      player.play(1);
      while (player.emitter.next_take_over(report)) {
        EXPECT_LE(report.first_sample, player.samples());
        EXPECT_TRUE(report.redrawn_sample == -1 || report.redrawn_sample >= report.first_sample);
      }
    }
    ASSERT_TRUE(player.watch.holds())
        << "round " << round << ": step " << player.watch.step << " m, slew " << player.watch.slew
        << ", power " << player.watch.power << " of " << settings.power_limit;
    EXPECT_NEAR(player.emitter.stats().max_focus_step, player.watch.step, 1e-12);
  }
}

TEST(PathEmitter, AtMost5PercentOfSamplesAreInAFade) {
  // 25 plans a second, from slowly drifting fields to plans unrelated to the previous one
  for (const double drift : {0.5e-3, 2e-3, 5e-3, 0.1}) {
    Random random(5);
    Player player(settings_for(4));
    std::array<Vec3, 4> centre;
    for (Vec3& c : centre) c = kCentre + 0.04 * Vec3(random.normal(), random.normal(), 0.0);
    constexpr int kPlans = 200;
    for (int k = 0; k < kPlans; ++k) {
      LiftedPlan& plan = player.emitter.draft();
      plan.paths.clear();
      for (Vec3& c : centre) {
        c += drift * Vec3(random.normal(), random.normal(), 0.1 * random.normal());
        plan.paths.push_back(ring(c, random.uniform(0.13, 0.14), 40, 1.0));
      }
      player.emitter.submit();
      player.play(40);
    }
    const EmitStats stats = player.emitter.stats();
    const double share = static_cast<double>(stats.faded) / static_cast<double>(stats.samples);
    EXPECT_LE(share, 0.05) << "drift of " << drift << " m per plan";
    if (drift <= 2e-3) {
      EXPECT_LE(share, 0.001);
    }
    EXPECT_EQ(stats.laps_cut, 0);
    EXPECT_TRUE(player.watch.holds());
  }
}

TEST(PathEmitter, DoesNotAllocate) {
  Player player(settings_for(8));
  Random random(9);
  const LiftedPlan plan = random_plan(random, 0.05);
  const test::HeapGuard guard;
  for (int k = 0; k < 20; ++k) {
    player.emitter.draft() = plan;
    player.emitter.submit();
    player.play(10);
    player.emitter.lose();
    player.play(5);
  }
  player.emitter.stats();
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(PathEmitter, PlansMayComeFromAnotherThread) {
  Player player(settings_for(4));
  std::atomic<bool> done{false};
  std::thread planner([&] {
    Random random(4);
    TakeOver report;
    for (int k = 0; k < 300; ++k) {
      player.emitter.draft() = random_plan(random, 0.02);
      player.emitter.submit();
      if (k % 50 == 49) player.emitter.lose();
      player.emitter.next_take_over(report);
      player.emitter.stats();
      std::this_thread::yield();
    }
    done = true;
  });
  while (!done) player.play(1);
  planner.join();
  EXPECT_TRUE(player.watch.holds());
}

TEST(PathEmitter, SettingsAreChecked) {
  const auto refused = [](auto change) {
    EmitSettings settings = settings_for(4);
    change(settings);
    try {
      const PathEmitter emitter(settings, 40e3);
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(refused([](EmitSettings&) {}), "accepted");
  EXPECT_EQ(refused([](EmitSettings& s) { s.foci = 9; }), "foci = 9 must be between 1 and 8");
  EXPECT_EQ(refused([](EmitSettings& s) { s.stall_fade_time = 1.0; }),
            "stall_fade_time = 1 s must be between 1e-6 and 0.04 s");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (double EmitSettings::*field :
       {&EmitSettings::full_scale_pressure, &EmitSettings::silent_below, &EmitSettings::power_limit,
        &EmitSettings::fade_time, &EmitSettings::stall_time, &EmitSettings::stall_fade_time}) {
    EXPECT_NE(refused([&](EmitSettings& s) { s.*field = nan; }), "accepted");
    EXPECT_NE(refused([&](EmitSettings& s) { s.*field = -1.0; }), "accepted");
  }
  EXPECT_NE(refused([](EmitSettings& s) { s.full_scale_pressure = 0.0; }), "accepted");
  EXPECT_THROW(PathEmitter(settings_for(4), 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace prostm
