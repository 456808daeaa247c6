#include <gmock/gmock.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>

#include "device/autd3_sdk/autd3_sdk_trial.hpp"
#include "prostm/device/autd3_sdk/autd3_sdk_array.hpp"
#include "support/stall_watch.hpp"

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

TEST(Autd3SdkFaults, ResumesAfterADisconnection) {
  test::SdkUnits chain;
  Moving source(4);
  const auto array = opened({.address = chain.address()});
  source.set_rate(array->info().sample_rate);
  ASSERT_EQ(started(*array, source), DeviceStatus::Running);
  ASSERT_TRUE(sounds_again(chain, 0.0));
  chain.tell("cut 500");
  const test::StallWatch stalls;
  const double end = static_cast<double>(now_ns()) * 1e-9 + 0.5;
  ASSERT_TRUE(test::eventually([&] { return array->status() == DeviceStatus::Vanished; }));
  EXPECT_THAT(array->problem(), HasSubstr("unit 0 was silent for 100 ms"));
  ASSERT_TRUE(test::eventually([&] { return array->status() == DeviceStatus::Running; }));
  ASSERT_TRUE(sounds_again(chain, end));
  const double gap = static_cast<double>(now_ns()) * 1e-9 - end;
  std::printf("sounding %.0f ms after the end of a cut\n", 1e3 * gap);
  EXPECT_LT(gap - stalls.held_up(), 1.0);
  EXPECT_EQ(array->problem(), "");
  const DeviceStats stats = array->stats();
  EXPECT_GE(stats.lost_links, 1);
  EXPECT_GE(static_cast<double>(stats.lost_blocks) * array->info().block_time(), 0.4);
  EXPECT_LE(stats.lost_blocks + stats.slow_blocks, stats.missed_blocks);
  EXPECT_LE(chain.report()["largest_speed_m_s"], 8.0);
}

TEST(Autd3SdkFaults, RenumbersUnitsAfterAPowerLoss) {
  test::SdkUnits chain({"--units", "2"});
  Moving source(4);
  const auto array = opened({.address = chain.address()});
  source.set_rate(array->info().sample_rate);
  ASSERT_EQ(started(*array, source), DeviceStatus::Running);
  // all units, or one of them while the other keeps its number
  for (const char* units : {"", " 0", " 1"}) {
    ASSERT_TRUE(sounds_again(chain, sounding(chain)));
    chain.tell(std::string("power-cycle") + units);
    const test::StallWatch stalls;
    const double cut = static_cast<double>(now_ns()) * 1e-9;
    ASSERT_TRUE(test::eventually([&] { return array->status() == DeviceStatus::Vanished; }));
    ASSERT_TRUE(test::eventually([&] { return array->status() == DeviceStatus::Running; }));
    ASSERT_TRUE(sounds_again(chain, static_cast<double>(now_ns()) * 1e-9));
    const double gap = static_cast<double>(now_ns()) * 1e-9 - cut;
    std::printf("sounding %.0f ms after unit%s lost its power\n", 1e3 * gap, units);
    EXPECT_LT(gap - stalls.held_up(), 2.0);
  }
  array->stop();
  EXPECT_EQ(chain.report()["protocol_errors"], 0) << chain.report();
}

TEST(Autd3SdkFaults, ReleasesUnitsFromTheFailsafe) {
  test::SdkUnits chain({"--units", "2"});
  Moving source(4);
  const auto array = opened({.address = chain.address()});
  source.set_rate(array->info().sample_rate);
  ASSERT_EQ(started(*array, source), DeviceStatus::Running);
  ASSERT_TRUE(sounds_again(chain, 0.0));
  chain.tell("hold-latch 1");
  chain.tell("latch");
  // or the unit is lost if the machine is too busy
  bool lost = false;
  ASSERT_TRUE(test::eventually([&] {
    lost = array->status() == DeviceStatus::Vanished;
    return lost || chain.report()["releases"] >= 4;
  }));
  const double muted = sounding(chain);
  EXPECT_TRUE(chain.report()["failsafe"]);
  chain.tell("hold-latch 0");
  ASSERT_TRUE(sounds_again(chain, muted));
  const auto report = chain.report();
  EXPECT_EQ(report["failsafe"], false);
  EXPECT_EQ(report["protocol_errors"], 0) << report;
  EXPECT_TRUE(lost || report["releases"] >= 6) << report;
  EXPECT_TRUE(lost || array->muted() >= 1);
}

/// Blocks the device's thread for a while, once.
class Stalling final : public SampleSource {
 public:
  explicit Stalling(SampleSource& from) : from_(from) {}
  int foci() const override { return from_.foci(); }
  void fill(std::int64_t first, std::span<FocusSample> out) noexcept override {
    if (const int time = stall_.exchange(0); time > 0) sleep(time);
    from_.fill(first, out);
  }
  void stall(int time) { stall_ = time; }

 private:
  SampleSource& from_;
  std::atomic<int> stall_{0};
};

TEST(Autd3SdkFaults, ResumesAfterAStall) {
  test::SdkUnits chain({"--units", "2", "--record"});
  Moving source(4);
  Stalling stalling(source);
  const auto array = opened({.address = chain.address()});
  source.set_rate(array->info().sample_rate);
  ASSERT_EQ(started(*array, stalling), DeviceStatus::Running);
  ASSERT_TRUE(sounds_again(chain, 0.0));
  for (const int time : {30, 60, 400}) {
    stalling.stall(time);
    sleep(time + 100);
    const double after = static_cast<double>(now_ns()) * 1e-9;
    ASSERT_TRUE(sounds_again(chain, after)) << time;
  }
  EXPECT_GE(array->muted(), 1);
  EXPECT_GE(array->stats().missed_blocks, 40);
  array->stop();
  const auto report = chain.report();
  EXPECT_EQ(report["protocol_errors"], 0) << report;
  EXPECT_LE(report["largest_speed_m_s"], 8.0);
}

TEST(Autd3SdkFaults, ReportsAHotUnit) {
  test::SdkUnits chain({"--units", "2"});
  Moving source(4);
  const auto array = opened({.address = chain.address()});
  source.set_rate(array->info().sample_rate);
  ASSERT_EQ(started(*array, source), DeviceStatus::Running);
  EXPECT_FALSE(array->is_hot());
  chain.tell("hot 1");
  EXPECT_TRUE(test::eventually([&] { return array->is_hot(); }));
  chain.tell("hot 0");
  EXPECT_TRUE(test::eventually([&] { return !array->is_hot(); }));
}

TEST(Autd3SdkFaults, UnitsFallSilentByThemselvesWhenTheProcessIsKilled) {
  test::SdkUnits chain({"--units", "2"});
  double longest = 0.0;
  for (int i = 0; i < 3; ++i) {
    const double before = sounding(chain);
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      // the child process ends here in any case
      try {
        Moving source(4);
        const auto array = opened({.address = chain.address()});
        source.set_rate(array->info().sample_rate);
        started(*array, source);
        for (;;) pause();
      } catch (...) {
        _exit(1);
      }
    }
    ASSERT_TRUE(sounds_again(chain, before));
    sleep(200 + 3 * i);
    kill(child, SIGKILL);
    const std::int64_t killed = now_ns();
    waitpid(child, nullptr, 0);
    sleep(250);
    const auto report = chain.report();
    const auto silent =
        static_cast<double>(report["last_sounding_ns"].get<std::int64_t>() - killed);
    EXPECT_TRUE(report["failsafe"]);
    longest = std::max(longest, silent * 1e-6);
  }
  std::printf("silent %.1f ms after kill -9, by the units' failsafe alone\n", longest);
  EXPECT_LE(longest, 110.0);
}

TEST(Autd3SdkFaults, VanishesWithASentenceWhenAUnitReportsAnError) {
  test::SdkUnits chain;
  Moving source(4);
  const auto array = opened({.address = chain.address()});
  source.set_rate(array->info().sample_rate);
  chain.tell("refuse 48 4");  // the silencer
  ASSERT_EQ(started(*array, source), DeviceStatus::Running);
  ASSERT_TRUE(test::eventually([&] { return array->status() == DeviceStatus::Vanished; }));
  EXPECT_THAT(array->problem(), HasSubstr("unit 0 refused the silencer's setting"));
  chain.tell("refuse 48 4 0");
  EXPECT_TRUE(test::eventually([&] { return array->status() == DeviceStatus::Running; }));
  ASSERT_TRUE(sounds_again(chain, 0.0));
}

}  // namespace
}  // namespace prostm
