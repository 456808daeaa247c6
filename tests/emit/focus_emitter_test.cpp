#include "prostm/emit/detail/focus_emitter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <set>

#include "emit/foci.hpp"
#include "emit/paths.hpp"
#include "prostm/emit/detail/envelope.hpp"
#include "support/heap_guard.hpp"

namespace prostm {
namespace {

using test::focus_at;
using test::settings_for;
using Player = test::FociPlayer;

constexpr double kRate = 40e3;
constexpr std::size_t kPeriod = 200;

EmitSettings with_waveform(const char* name, int foci = 1) {
  EmitSettings settings = settings_for(foci);
  settings.am_waveform = from_name<Waveform>(name, "am_waveform");
  return settings;
}

TEST(FocusEmitter, FollowsItsWaveform) {
  for (const char* name : {"raised-cosine", "sine-magnitude"}) {
    Player player(with_waveform(name));
    player.submit({focus_at(0.01, 0.0, 0.25)});
    player.play(3 * kPeriod);
    for (std::size_t k = 0; k < 3 * kPeriod; ++k) {
      const double turns = static_cast<double>(k % kPeriod) / kPeriod;
      const double a = std::string(name) == "raised-cosine"
                           ? 0.5 * (1.0 - std::cos(2.0 * kPi * turns))
                           : std::abs(std::sin(kPi * turns));
      EXPECT_NEAR(player.intensity(k), 0.5 * a, 1e-6) << name << " " << k;
    }
    EXPECT_EQ(player.intensity(kPeriod), 0.0);
    EXPECT_TRUE(player.watch.holds());
  }
}

TEST(FocusEmitter, TheRadiationPressureHasTheComponentsOfItsWaveform) {
  const auto parts = [](const char* name) {
    Player player(with_waveform(name));
    player.submit({focus_at(0.0, 0.0, 1.0)});
    player.play(20 * kPeriod);
    // components of intensity² at 0, 1 and 2 times the frequency
    std::array<double, 3> part{};
    for (std::size_t h = 0; h < part.size(); ++h) {
      double re = 0.0, im = 0.0;
      for (std::size_t k = 0; k < 20 * kPeriod; ++k) {
        const double angle = 2.0 * kPi * static_cast<double>(h * k) / kPeriod;
        const double pressure = player.intensity(k) * player.intensity(k);
        re += pressure * std::cos(angle);
        im += pressure * std::sin(angle);
      }
      part[h] = std::hypot(re, im) / (20.0 * kPeriod) * (h == 0 ? 1.0 : 2.0);
    }
    return part;
  };
  const auto cosine = parts("raised-cosine"), sine = parts("sine-magnitude");
  EXPECT_NEAR(cosine[0], 0.375, 1e-5);
  EXPECT_NEAR(cosine[1], 0.5, 1e-5);
  EXPECT_NEAR(cosine[2], 0.125, 1e-5);
  EXPECT_NEAR(sine[0], 0.5, 1e-5);
  EXPECT_NEAR(sine[1], 0.5, 1e-5);
  EXPECT_NEAR(sine[2], 0.0, 1e-5);
}

TEST(FocusEmitter, MovesAtTheNextZeroBetweenTwoSilentSamples) {
  Player player(settings_for(1));
  player.submit({focus_at(0.0, 0.0, 1.0)});
  player.play(250);  // in the middle of a period
  player.submit({focus_at(0.05, 0.0, 0.25)}, 2);
  player.play(400);
  for (std::size_t k = 0; k <= 400; ++k) EXPECT_EQ(player.at(k, 0).p_D.x(), 0.0F) << k;
  for (std::size_t k = 401; k < 650; ++k) EXPECT_EQ(player.at(k, 0).p_D.x(), 0.05F) << k;
  EXPECT_EQ(player.intensity(400), 0.0);
  EXPECT_EQ(player.intensity(401), 0.0);
  EXPECT_NEAR(player.intensity(501), 0.5, 1e-6);  // the new peak
  EXPECT_TRUE(player.watch.holds());
  EXPECT_EQ(player.emitter.stats().max_focus_step, 0.0);
  TakeOver report;
  ASSERT_TRUE(player.emitter.next_take_over(report));
  EXPECT_EQ(report.plan, 1);
  EXPECT_EQ(report.first_sample, 0);
  EXPECT_EQ(report.redrawn_sample, 179);  // nine tenths of a period
  ASSERT_TRUE(player.emitter.next_take_over(report));
  EXPECT_EQ(report.plan, 2);
  EXPECT_EQ(report.first_sample, 401);
}

TEST(FocusEmitter, MinimisesTravel) {
  Player player(settings_for(3));
  player.submit({focus_at(0.0, 0.0, 1.0), focus_at(0.04, 0.0, 1.0), focus_at(0.08, 0.0, 1.0)});
  player.play(300);
  player.submit({focus_at(0.081, 0.0, 1.0), focus_at(0.001, 0.0, 1.0)}, 2);
  player.play(300);
  std::multiset<float> before, after;
  for (std::size_t f = 0; f < 3; ++f) {
    const float moved = player.at(599, f).p_D.x() - player.at(299, f).p_D.x();
    EXPECT_NEAR(moved, player.intensity(500, f) > 0.0 ? 0.001 : 0.0, 1e-6) << f;
  }
}

TEST(FocusEmitter, ExcessFociAreCounted) {
  Player player(settings_for(1));
  player.submit({focus_at(0.0, 0.0, 1.0), focus_at(0.04, 0.0, 0.5)});
  player.play(300);
  EXPECT_EQ(player.emitter.stats().dropped_paths, 1);
  EXPECT_NEAR(player.intensity(100), 1.0, 1e-6);
}

TEST(FocusEmitter, IsSilentFromTheNextZeroAfterALoss) {
  Player player(settings_for(2));
  player.submit({focus_at(0.0, 0.0, 1.0), focus_at(0.04, 0.0, 1.0)});
  player.play(250);
  player.emitter.lose();
  player.play(600);
  EXPECT_GT(player.intensity(399), 0.0);
  for (std::size_t k = 400; k < 850; ++k) EXPECT_EQ(player.intensity(k), 0.0) << k;
  // a new plan resumes the output at once
  player.submit({focus_at(0.0, 0.01, 1.0)}, 2);
  player.play(200);
  EXPECT_NEAR(player.intensity(850 + 100), 1.0, 1e-6);
  EXPECT_TRUE(player.watch.holds());
}

TEST(FocusEmitter, IsSilentWhileMutedAndResumesWithTheNextPlan) {
  const auto mute = std::make_shared<Mute>();
  Player player(settings_for(1));
  player.emitter.obey(mute);
  player.submit({focus_at(0.0, 0.0, 1.0)});
  player.play(250);
  mute->set(MuteReason::Calibration, true);
  player.play(500);
  player.submit({focus_at(0.0, 0.01, 1.0)}, 2);
  player.play(500);
  EXPECT_GT(player.intensity(399), 0.0);
  for (std::size_t k = 400; k < 1250; ++k) EXPECT_EQ(player.intensity(k), 0.0) << k;
  mute->set(MuteReason::Calibration, false);
  player.play(200);
  player.submit({focus_at(0.0, 0.01, 1.0)}, 3);
  player.play(200);
  EXPECT_EQ(player.intensity(1250 + 100), 0.0) << "the earlier plan is dropped";
  EXPECT_NEAR(player.intensity(1450 + 100), 1.0, 1e-6);
  EXPECT_TRUE(player.watch.holds());
}

TEST(FocusEmitter, AStallEndsInSilenceAfter100Milliseconds) {
  Player player(settings_for(1));
  player.submit({focus_at(0.0, 0.0, 1.0)});
  player.play(6000);
  EXPECT_GT(player.intensity(3999), 0.0);
  for (std::size_t k = 4000 + kPeriod; k < 6000; ++k) EXPECT_EQ(player.intensity(k), 0.0);
  EXPECT_EQ(player.emitter.stats().stalls, 1);
}

TEST(FocusEmitter, InvalidPlansAreRejected) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  LiftedPlan bad_place, bad_pressure, far, paths;
  bad_place.foci.push_back({Vec3(nan, 0.0, 0.2), 1.0});
  bad_pressure.foci.push_back({Vec3(0.0, 0.0, 0.2), nan});
  far.foci.push_back({Vec3(11.0, 0.0, 0.2), 1.0});
  paths.paths.push_back(test::ring(Vec3(0.0, 0.0, 0.2), 0.1, 20, 1.0));
  Player player(settings_for(1));
  int refused = 0;
  for (const LiftedPlan& plan : {bad_place, bad_pressure, far, paths}) {
    player.submit({focus_at(0.0, 0.0, 1.0)});
    player.play(300);
    player.emitter.draft() = plan;
    player.emitter.submit();
    player.play(300);
    EXPECT_EQ(player.emitter.stats().refused_plans, ++refused);
    EXPECT_EQ(player.kept.back().intensity, 0.0F);
  }
  EXPECT_TRUE(player.watch.holds());

  // an emitter of paths does not take foci either
  test::Player other(settings_for(1));
  other.emitter.draft().paths.clear();
  other.emitter.draft().foci.push_back(focus_at(0.0, 0.0, 1.0));
  other.emitter.submit();
  other.play(1);
  EXPECT_EQ(other.emitter.stats().refused_plans, 1);
}

TEST(FocusEmitter, PowerLimitScalesAllFociAlike) {
  EmitSettings settings = settings_for(4);
  settings.power_limit = 1.0;
  Player player(settings);
  player.submit({focus_at(0.0, 0.0, 1.0), focus_at(0.03, 0.0, 1.0), focus_at(0.06, 0.0, 1.0),
                 focus_at(0.09, 0.0, 0.25)});
  player.play(kPeriod);
  // Σ I² would be 3.25
  std::vector<double> peaks;
  for (std::size_t f = 0; f < 4; ++f) peaks.push_back(player.intensity(100, f));
  std::sort(peaks.begin(), peaks.end());
  EXPECT_NEAR(peaks[3], 1.0 / std::sqrt(3.25), 1e-6);
  EXPECT_NEAR(peaks[0], 0.5 / std::sqrt(3.25), 1e-6);
  EXPECT_TRUE(player.watch.holds());
  EXPECT_EQ(player.emitter.stats().limited, 4 * (static_cast<int>(kPeriod) - 1));
}

TEST(FocusEmitter, GuaranteesHoldForAnySequenceOfPlans) {
  Random random(12);
  for (int trial = 0; trial < 40; ++trial) {
    EmitSettings settings = settings_for(1 + random.below(8), 0.7);
    settings.power_limit = random.uniform(0.5, 8.0);
    settings.am_frequency = random.uniform(25.0, kRate / 126.0);
    settings.am_waveform = trial % 2 == 0 ? Waveform::RaisedCosine : Waveform::SineMagnitude;
    Player player(settings);
    for (int k = 0; k < 60; ++k) {
      if (random.uniform() < 0.1) {
        player.emitter.lose();
      } else {
        LiftedPlan& plan = player.emitter.draft();
        plan.paths.clear();
        plan.foci.clear();
        for (int f = random.below(9); f > 0; --f) {
          plan.foci.push_back(
              focus_at(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform()));
        }
        player.emitter.submit();
      }
      player.play(1 + static_cast<std::size_t>(random.below(900)));
    }
    ASSERT_NO_FATAL_FAILURE(expect_within_bounds(player)) << trial;
  }
}

TEST(FocusEmitter, BlocksOfAnyLengthGiveTheSameSamples) {
  Player whole(settings_for(1)), parts(settings_for(1));
  whole.submit({focus_at(0.0, 0.0, 1.0)});
  parts.submit({focus_at(0.0, 0.0, 1.0)});
  whole.play(999);
  for (const std::size_t n : {1u, 398u, 200u, 400u}) parts.play(n);
  for (std::size_t k = 0; k < 999; ++k) ASSERT_EQ(whole.intensity(k), parts.intensity(k)) << k;
}

TEST(FocusEmitter, DoesNotAllocate) {
  FocusEmitter emitter(settings_for(8), kRate);
  std::vector<FocusSample> block(8 * 40);
  LiftedPlan plan;
  for (int f = 0; f < 8; ++f) plan.foci.push_back(focus_at(0.01 * f, 0.0, 1.0));
  std::int64_t first = 0;
  const test::HeapGuard guard;
  for (int k = 0; k < 40; ++k) {
    emitter.draft() = plan;
    emitter.submit();
    emitter.fill(40 * first++, block);
    if (k % 7 == 0) emitter.lose();
    emitter.fill(40 * first++, block);
  }
  emitter.stats();
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(FocusEmitter, SettingsAreChecked) {
  const auto refuses = [](double frequency, double rate) {
    EmitSettings settings = settings_for(1);
    settings.am_frequency = frequency;
    EXPECT_THROW(FocusEmitter(settings, rate), std::invalid_argument) << frequency;
  };
  refuses(24.0, kRate);
  refuses(kRate / 125.0, kRate);
  refuses(std::nan(""), kRate);
  refuses(25.0, 3000.0);
  EmitSettings settings = settings_for(1);
  settings.am_frequency = kRate / 126.0;
  EXPECT_EQ(FocusEmitter(settings, kRate).period(), 126);
}

}  // namespace
}  // namespace prostm
