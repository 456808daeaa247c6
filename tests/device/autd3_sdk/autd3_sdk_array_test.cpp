#include "prostm/device/autd3_sdk/autd3_sdk_array.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "device/autd3_sdk/autd3_sdk_trial.hpp"
#include "prostm/device/detail/slot_encoder.hpp"

namespace prostm {
namespace {

using test::Moving;
using test::now_ns;
using test::opened;
using test::sleep;
using test::sounding;
using test::sounds_again;
using test::started;
using testing::HasSubstr;

/// A sample that a unit played, as written by the stand-in.
struct Played {
  std::int64_t unit, tick;
  std::uint32_t slots, muted;
  std::array<std::uint64_t, 8> words;

  bool is_blank() const { return words[0] == 0 && words[1] == 0; }
  Vec3 place(std::size_t slot) const {
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis) {
      auto value = static_cast<std::int64_t>(words[slot] >> (18 * axis) & 0x3FFFF);
      if (value >= 1 << 17) value -= 1 << 18;
      p[axis] = 0.025e-3 * static_cast<double>(value);
    }
    return p;
  }
};

/// The samples of the stream that a unit played, without the silent blocks around them.
std::vector<Played> played_by(test::SdkUnits& chain, std::int64_t unit) {
  const std::string file =
      (std::filesystem::temp_directory_path() / ("sdk_units_" + std::to_string(getpid()))).string();
  chain.tell("dump " + file);
  std::ifstream in(file, std::ios::binary);
  std::vector<Played> all;
  Played p{};
  while (in.read(reinterpret_cast<char*>(&p), sizeof(p)))
    if (p.unit == unit && !p.is_blank()) all.push_back(p);
  in.close();
  std::filesystem::remove(file);
  return all;
}

Pose side_by_side(int unit, int units) {
  const double x = 0.192 * (unit - 0.5 * (units - 1));
  return Pose(Eigen::Translation3d(x, 0.0, 0.0)) * autd3_middle();
}

/// Checks that a unit played the source's samples, each once and in order.
void expect_stream(const std::vector<Played>& played, const Moving& source, const Pose& X_DU,
                   std::size_t least) {
  ASSERT_GE(played.size(), least);
  double worst = 0.0;
  for (std::size_t i = 0; i < played.size(); ++i) {
    for (int f = 0; f < source.foci(); ++f) {
      const auto slot =
          static_cast<std::size_t>(f) * played[i].slots / static_cast<std::size_t>(source.foci());
      const Vec3 p_D = X_DU * played[i].place(slot);
      worst = std::max(worst, (p_D - source.position(static_cast<std::int64_t>(i), f)).norm());
    }
  }
  EXPECT_LT(worst, 0.05e-3);
}

/// Whether a unit was lost in between, so that data written to it were never played. Otherwise
/// units are cleared only when they are found, at the start and at the end.
bool was_lost(const nlohmann::json& report, int units) {
  return report["clears"].get<int>() > 3 * units;
}

TEST(Autd3SdkBudget, FollowsFromFramesPerMillisecond) {
  const Autd3SdkBudget fast = best_autd3_sdk_budget(8, 20.0);
  EXPECT_EQ(fast.divider, 4);
  EXPECT_EQ(fast.block_samples, 100);
  EXPECT_EQ(fast.block_frames, 7);  // 800 foci in frames of 179, a bank change, a status request
  EXPECT_DOUBLE_EQ(fast.block_time, 10e-3);
  EXPECT_DOUBLE_EQ(fast.load, 7.0 / 200.0);
  const Autd3SdkBudget slow = best_autd3_sdk_budget(8, 1.0);
  EXPECT_GT(slow.divider, 4);
  EXPECT_LE(slow.load, 0.5);
  EXPECT_THROW(best_autd3_sdk_budget(8, 0.1), std::invalid_argument);
}

TEST(Autd3SdkArray, ReportsItsCapabilitiesWithoutUnits) {
  const DeviceInfo info = Autd3SdkArray::info_of({.address = "%lo"});
  EXPECT_DOUBLE_EQ(info.sample_rate, 10e3);
  EXPECT_EQ(info.decimation, 4);
  EXPECT_DOUBLE_EQ(info.emission_rate(), 40e3);
  EXPECT_TRUE(info.intensity_per_focus);
}

TEST(Autd3SdkArray, StreamsEverySampleOnceAndInOrder) {
  for (const int units : {1, 3}) {
    test::SdkUnits chain({"--units", std::to_string(units), "--record"});
    Moving source(4);
    const auto array = opened({.address = chain.address()});
    source.set_rate(array->info().sample_rate);
    ASSERT_EQ(started(*array, source), DeviceStatus::Running) << array->problem();
    ASSERT_TRUE(test::eventually([&] { return source.filled() > 13'000; })) << array->problem();
    EXPECT_GT(array->samples(), 1000);
    const int allocations = source.allocations();
    array->stop();
    const auto report = chain.report();
    EXPECT_TRUE(allocations == 0 || was_lost(report, units)) << allocations;
    EXPECT_EQ(report["protocol_errors"], 0) << report;
    EXPECT_LE(report["largest_speed_m_s"], 8.0);
    std::printf("%d units: %s, %lld blocks, %lld missed, at most %.2f m/s\n", units,
                array->description().c_str(), static_cast<long long>(array->stats().blocks),
                static_cast<long long>(array->stats().missed_blocks),
                report["largest_speed_m_s"].get<double>());
    for (int u = 0; u < units && !was_lost(report, units); ++u)
      expect_stream(played_by(chain, u), source, side_by_side(u, units), 12'000);
  }
}

TEST(Autd3SdkArray, SendsEachUnitItsOwnPositions) {
  test::SdkUnits chain({"--units", "2", "--record"});
  const Pose turned =
      Pose(Eigen::Translation3d(0.25, 0.1, 0.05) * Eigen::AngleAxisd(-0.6, Vec3::UnitY()));
  Moving source(8);  // foci that share one intensity
  const auto array = opened({.address = chain.address(),
                             .units = {autd3_middle(), turned},
                             .foci = 8,
                             .own_intensities = false});
  EXPECT_EQ(array->info().max_foci, 8);
  source.set_rate(array->info().sample_rate);
  ASSERT_EQ(started(*array, source), DeviceStatus::Running) << array->problem();
  ASSERT_TRUE(test::eventually([&] { return source.filled() > 3'000; })) << array->problem();
  array->stop();
  const auto report = chain.report();
  EXPECT_EQ(report["protocol_errors"], 0) << report;
  if (was_lost(report, 2)) return;
  expect_stream(played_by(chain, 0), source, autd3_middle(), 2'000);
  expect_stream(played_by(chain, 1), source, turned, 2'000);
}

TEST(Autd3SdkArray, WorksWithFirmwareThatNeedsAMargin) {
  test::SdkUnits chain({"--activate-bytes", "14", "--record"});
  Moving source(4);
  const auto array = opened({.address = chain.address()});
  source.set_rate(array->info().sample_rate);
  ASSERT_EQ(started(*array, source), DeviceStatus::Running) << array->problem();
  ASSERT_TRUE(sounds_again(chain, 0.0)) << array->problem();
  sleep(300);
  array->stop();
  EXPECT_EQ(chain.report()["protocol_errors"], 0);
  if (!was_lost(chain.report(), 1))
    expect_stream(played_by(chain, 0), source, side_by_side(0, 1), 1'000);
}

TEST(Autd3SdkArray, SurvivesLossDelayAndReordering) {
  for (const char* fault : {"drop 2", "reorder 10", "delay 1500"}) {
    test::SdkUnits chain({"--units", "2", "--record"});
    Moving source(4);
    const auto array = opened({.address = chain.address()});
    source.set_rate(array->info().sample_rate);
    ASSERT_EQ(started(*array, source), DeviceStatus::Running) << array->problem();
    ASSERT_TRUE(sounds_again(chain, 0.0));
    chain.tell(fault);
    const std::int64_t before = source.filled();
    ASSERT_TRUE(test::eventually([&] { return source.filled() > before + 12'000; }))
        << fault << ": " << array->problem();
    EXPECT_TRUE(sounds_again(chain, sounding(chain))) << fault;
    const auto report = chain.report();
    EXPECT_EQ(report["protocol_errors"], 0) << fault << report;
    EXPECT_LE(report["largest_speed_m_s"], 8.0) << fault << report;
    const DeviceStats stats = array->stats();
    std::printf("%s: %lld of %lld blocks late, %s\n", fault,
                static_cast<long long>(stats.late_blocks), static_cast<long long>(stats.blocks),
                report.dump().c_str());
    chain.tell("drop 0"), chain.tell("reorder 0"), chain.tell("delay 0");
    array->stop();
    if (!was_lost(chain.report(), 2))
      expect_stream(played_by(chain, 0), source, side_by_side(0, 2), 9'000);
  }
}

TEST(Autd3SdkArray, IsSilentAfterStop) {
  test::SdkUnits chain;
  Moving source(4);
  const auto array = opened({.address = chain.address()});
  source.set_rate(array->info().sample_rate);
  // A unit without datagrams trips its failsafe after 80 ms, which silences it, too: a process that
  // is held up for that long shows nothing.
  constexpr std::int64_t kFailsafe = 80'000'000;  // [ns]
  int shown = 0;
  for (int i = 0; i < 20 && shown < 2; ++i) {
    const double before = sounding(chain);
    ASSERT_EQ(started(*array, source), DeviceStatus::Running) << array->problem();
    ASSERT_TRUE(sounds_again(chain, before));
    const std::int64_t begin = now_ns();
    const auto trips = chain.report()["trips"];
    array->stop();
    const std::int64_t stopped = now_ns();
    EXPECT_EQ(array->status(), DeviceStatus::Idle);
    sleep(20);
    const auto report = chain.report();
    if (now_ns() - begin < kFailsafe) {
      EXPECT_LT(report["last_sounding_ns"].get<std::int64_t>(), stopped);
      EXPECT_EQ(report["trips"], trips);
      ++shown;
    }
    sleep(100);  // until the failsafe of an idle unit has tripped
  }
  EXPECT_EQ(shown, 2);
  EXPECT_EQ(chain.report()["protocol_errors"], 0);
}

TEST(Autd3SdkArray, RejectsInvalidSetups) {
  EXPECT_THROW(Autd3SdkArray({.address = "%no-such-card"}), std::invalid_argument);
  test::SdkUnits chain;
  EXPECT_THROW(Autd3SdkArray({.address = chain.address(), .foci = 5}), std::invalid_argument);
  Moving source(3);
  const auto array = opened({.address = chain.address(), .foci = 2});
  EXPECT_EQ(array->start(source), DeviceStatus::Refused);
  EXPECT_THAT(array->problem(), HasSubstr("1 to 2 focal points, not 3"));
  const std::vector<FocusSample> sample(3);
  EXPECT_EQ(array->load_segment(sample, 3), DeviceStatus::Refused);
  EXPECT_EQ(array->load_segment({}, 1), DeviceStatus::Refused);
}

/// A circle of one focal point, n samples per lap.
std::vector<FocusSample> circle(int n, double radius) {
  std::vector<FocusSample> samples;
  for (int i = 0; i < n; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / n;
    const Vec3 p(radius * std::cos(angle), radius * std::sin(angle), 0.2);
    samples.push_back({p.cast<float>(), 0.8F});
  }
  return samples;
}

TEST(Autd3SdkArray, RepeatsSegmentsInWholeLaps) {
  test::SdkUnits chain({"--record"});
  const auto array = opened({.address = chain.address(), .foci = 1});
  const std::vector<FocusSample> small = circle(130, 0.015), large = circle(230, 0.02);
  ASSERT_EQ(array->load_segment(small, 1), DeviceStatus::Running) << array->problem();
  ASSERT_TRUE(sounds_again(chain, 0.0));
  const auto plays_up_to = [&](std::int64_t sample) {
    return test::eventually([&] { return array->samples() > sample; });
  };
  ASSERT_TRUE(plays_up_to(2'000));
  ASSERT_EQ(array->load_segment(large, 1), DeviceStatus::Running) << array->problem();
  ASSERT_TRUE(plays_up_to(4'000));
  array->stop();
  const auto report = chain.report();
  EXPECT_EQ(report["protocol_errors"], 0) << report;
  if (was_lost(report, 1)) return;
  // every lap begins where the one before ends
  std::size_t at = 0, laps = 0;
  const std::vector<FocusSample>* loop = &small;
  for (const Played& p : played_by(chain, 0)) {
    const Vec3 p_D = autd3_middle() * p.place(0);
    if (at == 0 && loop == &small && (p_D - large[0].p_D.cast<double>()).norm() < 1e-3)
      loop = &large;
    ASSERT_LT((p_D - (*loop)[at].p_D.cast<double>()).norm(), 0.05e-3) << laps << " " << at;
    at = (at + 1) % loop->size();
    laps += at == 0 ? 1 : 0;
  }
  EXPECT_EQ(loop, &large);
  EXPECT_GT(laps, 15U);
}

}  // namespace
}  // namespace prostm
