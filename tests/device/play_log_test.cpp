#include "prostm/device/ultraleap/detail/play_log.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace prostm {
namespace {

TEST(PlayLog, ReportsWhenSamplesWereRequestedAndPlayed) {
  PlayLog log;
  log.reset(16e3);
  EXPECT_EQ(log.played(100.0), 0);
  // calls of 16 samples each millisecond, 3 ms ahead; 16 more are requested than given
  for (int k = 0; k < 100; ++k)
    log.add({16 * k, 16, 10.003 + 0.001 * k, k == 0 ? 0 : 16 * k + 16, 10.0 + 0.001 * k});
  EXPECT_NEAR(log.play_time(0), 10.003, 1e-9);
  EXPECT_NEAR(log.play_time(24), 10.0045, 1e-9);
  EXPECT_NEAR(log.play_time(1600), 10.103, 1e-9) << "extrapolates at the sample rate";
  EXPECT_NEAR(log.ask_time(31), 10.0, 1e-3);
  EXPECT_NEAR(log.ask_time(32), 10.001, 1e-9);
  EXPECT_EQ(log.played(10.0029), 0);
  EXPECT_EQ(log.played(10.00301), 1);
  EXPECT_EQ(log.played(10.0045 + 1e-6), 25);
  EXPECT_EQ(log.played(20.0), 1600) << "only given samples are played";
}

TEST(PlayLog, DropsOldCallsAndStaysOrdered) {
  PlayLog log;
  log.reset(1e3);
  for (int k = 0; k < 10'000; ++k) log.add({k, 1, 1e-3 * k, k, 1e-3 * k});
  EXPECT_NEAR(log.play_time(9'000), 9.0, 1e-9);
  EXPECT_NEAR(log.play_time(10), 0.01, 1e-9) << "extrapolated at the sample rate";
  EXPECT_EQ(log.played(9.5 + 1e-6), 9'501);
}

TEST(PlayLog, CanBeReadWhileItGrows) {
  PlayLog log;
  log.reset(1e3);
  std::atomic<bool> done{false};
  std::jthread writer([&] {
    for (int k = 0; k < 200'000; ++k) log.add({k, 1, 1e-3 * k, k, 1e-3 * k});
    done = true;
  });
  while (!done) {
    const PlayLog::Call call = log.newest();
    ASSERT_NEAR(call.play_time, 1e-3 * static_cast<double>(call.first), 1e-9);
    ASSERT_EQ(call.first, call.pulled);
  }
}

}  // namespace
}  // namespace prostm
