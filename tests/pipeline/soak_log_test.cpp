// The dips of synthetic long runs, and the causes assigned to them.

#include "prostm/pipeline/realtime/soak_log.hpp"

#include <gmock/gmock.h>

#include <functional>

namespace prostm {
namespace {

using testing::HasSubstr;

constexpr double kSeconds = 90.0;

/// A soak test that samples the counters every 2 ms and the machine every 250 ms.
struct Soak {
  explicit Soak(bool load = true) : log(kSeconds, load, 2) { log.use(0.0, {}); }

  /// Advances to a time, optionally with a change of the counters or of the machine.
  void to(double end, const std::function<void(SoakCounts&, MachineUse&)>& change = {}) {
    if (change) change(counts, use);
    for (; time < end; time += 0.002) {
      use.busy += 0.002;  // all of it by this program
      use.own += 0.002;
      log.count(time, counts);
      if (time - looked < 0.25) continue;
      looked = time;
      log.use(time, use);
    }
  }
  /// The only dip.
  const SoakDip& dip() const {
    EXPECT_EQ(log.dips().size(), 1U);
    return log.dips().front();
  }

  SoakLog log;
  SoakCounts counts;
  MachineUse use;
  double time = 0.0, looked = 0.0;
};

TEST(SoakLog, TheLastPartContainsADipThatWasCountedLate) {
  Soak soak;
  soak.to(kSeconds);
  soak.counts.device.missed_blocks = 1;
  soak.log.count(kSeconds + 0.3, soak.counts);
  soak.log.end(kSeconds, soak.use);
  EXPECT_EQ(soak.dip().time, kSeconds + 0.3);
  EXPECT_EQ(soak.log.parts()[2].to, kSeconds + 0.3);
}

TEST(SoakLog, AQuietRunHasNoDips) {
  Soak soak;
  soak.to(kSeconds);
  soak.log.end(kSeconds, soak.use);
  EXPECT_TRUE(soak.log.dips().empty() && soak.log.is_quiet_clean());
}

TEST(SoakLog, CountersMayStartBeforeTheRun) {
  Soak soak;
  soak.to(1.0, [](SoakCounts& counts, MachineUse&) { counts.device.missed_blocks = 3; });
  soak.log.end(1.0, soak.use);
  EXPECT_TRUE(soak.log.dips().empty());
}

TEST(SoakLog, WatchesEveryCounterOfTheDeviceThatShouldStaySmall) {
  for (const Quantity<DeviceStats>& quantity : quantities<DeviceStats>()) {
    if (quantity.better != Better::Less) continue;
    Soak soak;
    soak.to(5.0);
    soak.to(6.0, [&](SoakCounts& counts, MachineUse&) {
      std::visit(
          [&](auto member) {
            if constexpr (std::is_member_object_pointer_v<decltype(member)>)
              counts.device.*member += 1;
          },
          quantity.value);
    });
    EXPECT_EQ(soak.dip().count, 1) << quantity.name;
    EXPECT_NEAR(soak.dip().time, 5.0, 0.01);
    EXPECT_EQ(soak.log.is_quiet_clean(), soak.dip().covered);
  }
}

TEST(SoakLog, ALateBlockIsCoveredUnlessItWasMissed) {
  Soak soak;
  soak.to(5.0);
  soak.to(6.0, [](SoakCounts& counts, MachineUse&) { counts.device.late_blocks += 3; });
  EXPECT_TRUE(soak.dip().covered && soak.log.is_quiet_clean());
  soak.to(7.0, [](SoakCounts& counts, MachineUse&) {
    counts.device.late_blocks += 1;
    counts.device.missed_blocks += 2;
  });
  ASSERT_EQ(soak.log.dips().size(), 2U);
  EXPECT_EQ(soak.log.dips()[1].what, "missed blocks");
  EXPECT_EQ(soak.log.dips()[1].count, 2);
  EXPECT_FALSE(soak.log.is_quiet_clean());
}

TEST(SoakLog, DipsUnderTheTestLoadAreExcused) {
  Soak soak;
  soak.to(31.0);
  EXPECT_TRUE(soak.log.is_loaded_at(31.0) && !soak.log.is_loaded_at(29.0));
  soak.to(60.5, [](SoakCounts& counts, MachineUse&) { counts.skipped_steps += 4; });
  // the load is over, and the queue refills
  EXPECT_FALSE(soak.log.is_loaded_at(60.5));
  soak.to(60.9, [](SoakCounts& counts, MachineUse&) { counts.skipped_plans += 1; });
  EXPECT_TRUE(soak.log.is_quiet_clean());
  ASSERT_EQ(soak.log.dips().size(), 2U);
  EXPECT_THAT(soak.log.dips()[1].cause, HasSubstr("load"));
  EXPECT_EQ(soak.log.parts()[1].dips, 5);
  soak.to(62.0);
  soak.to(63.0, [](SoakCounts& counts, MachineUse&) { counts.skipped_plans += 1; });
  EXPECT_FALSE(soak.log.is_quiet_clean());
}

TEST(SoakLog, WithoutALoadAllPartsAreQuiet) {
  Soak soak(false);
  soak.to(45.0);
  EXPECT_FALSE(soak.log.is_loaded_at(45.0));
  soak.to(46.0, [](SoakCounts& counts, MachineUse&) { counts.stalls += 1; });
  EXPECT_FALSE(soak.log.is_quiet_clean());
}

TEST(SoakLog, NamesTheLikelyCause) {
  const auto cause = [](const std::function<void(SoakCounts&, MachineUse&)>& evidence,
                        double wait = 0.0) {
    Soak soak;
    soak.to(5.0);
    soak.time += wait;
    soak.to(6.0, [&](SoakCounts& counts, MachineUse& use) {
      counts.skipped_steps += 1;
      evidence(counts, use);
    });
    return soak.dip().cause;
  };
  const auto nothing = [](SoakCounts&, MachineUse&) {};
  EXPECT_EQ(cause(nothing), "the system woke a thread late");
  EXPECT_EQ(cause(nothing, 0.05), "the system kept the program waiting for 52 ms");
  EXPECT_THAT(cause([](SoakCounts&, MachineUse& use) { use.stolen += 0.03; }),
              HasSubstr("host of this virtual machine took the processor for 30 ms"));
  EXPECT_THAT(cause([](SoakCounts&, MachineUse& use) { use.busy += 0.2; }),
              HasSubstr("other programs took 0.8 of 2 cores"));
  EXPECT_THAT(cause([](SoakCounts&, MachineUse& use) { use.faults += 2; }),
              HasSubstr("memory came back from a disk (2 page faults)"));
  EXPECT_THAT(cause([](SoakCounts& counts, MachineUse&) { counts.problem = "The link is slow."; }),
              HasSubstr("the device: The link is slow."));
}

TEST(SoakLog, ASlowStepIsACauseAndRatesAreKeptPerPart) {
  Soak soak(false);
  soak.to(5.0);
  for (int step = 2; step <= 500; step += 2)
    soak.log.update(0.02 * step, step, step / 2, step == 250 ? 0.031 : 0.01, 0.02);
  EXPECT_NEAR(soak.log.parts()[0].world_rate, 50.0, 1e-9);
  EXPECT_NEAR(soak.log.parts()[0].plan_rate, 25.0, 1e-9);
  soak.to(6.0, [](SoakCounts& counts, MachineUse&) { counts.skipped_steps += 1; });
  EXPECT_THAT(soak.dip().cause, HasSubstr("took 31 ms"));
}

TEST(SoakLog, StoresALimitedNumberOfDipsAndCountsTheRest) {
  Soak soak;
  soak.to(0.01);
  for (int i = 0; i < 12'000; ++i)
    soak.to(soak.time + 0.002, [](SoakCounts& counts, MachineUse&) { counts.skipped_steps += 1; });
  soak.to(65.0);
  EXPECT_EQ(soak.log.dips().size(), SoakLog::kMostDips);
  EXPECT_EQ(soak.log.left_out() + static_cast<std::int64_t>(SoakLog::kMostDips),
            soak.log.parts()[0].dips);
  // those of another part are still stored
  soak.to(66.0, [](SoakCounts& counts, MachineUse&) { counts.skipped_steps += 1; });
  ASSERT_EQ(soak.log.dips().size(), SoakLog::kMostDips + 1);
  EXPECT_EQ(soak.log.dips().back().part, 2);
}

TEST(MachineUse, GrowsWithTheWorkOfThisProgram) {
  const MachineUse before = machine_use();
  volatile double sum = 0.0;
  while (machine_use().own - before.own < 0.1) sum = sum + 1.0;
  const MachineUse after = machine_use();
  EXPECT_GE(after.own - before.own, 0.1);
  EXPECT_GT(after.busy, before.busy);
}

}  // namespace
}  // namespace prostm
