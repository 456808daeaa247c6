#include "prostm/pipeline/latency.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <numeric>
#include <set>
#include <string>

#include "prostm/device/simulated/simulated_array.hpp"
#include "prostm/pipeline/runner.hpp"

namespace prostm {
namespace {

double sum(const Latency& latency) {
  return std::accumulate(latency.part.begin(), latency.part.end(), 0.0);
}

WorldFrame contact_taken_at(double time, double age) {
  WorldFrame contact;
  contact.arrival = time - age;
  contact.due = contact.taken = time;
  contact.track_time = 0.001;  // stages take time even in a stepped run
  contact.meet_time = 0.003;
  return contact;
}

TEST(LatencyLog, WithoutAClockMatchesAHandCalculation) {
  SimulatedArraySettings settings;
  settings.realtime = false;
  const SimulatedArray device(settings, usx_array(), Medium{});
  LatencyLog log(false);
  EXPECT_FALSE(log.last().has_value());
  // taken at 100 ms from a 4 ms old frame; blocks from sample 4040 (101 ms) on use the plan, the
  // first path follows it from sample 5000 (125 ms) on, redrawn at 5800 (145 ms)
  PlanFrame plan;
  plan.id = 7;
  plan.start = 0.1;
  plan.plan_time = 0.002;
  log.plan(contact_taken_at(0.1, 0.004), plan, 0.0);
  log.follow({7, 4040, 5000, 5800}, device);
  const Latency& last = log.last().value();
  EXPECT_NEAR(last.total, 0.029, 1e-12);
  EXPECT_NEAR(last.part[kFrameWait], 0.004, 1e-12);
  EXPECT_NEAR(last.part[kBlockWait], 0.001, 1e-12);
  EXPECT_NEAR(last.part[kLapWait], 0.024, 1e-12);
  EXPECT_EQ(last.part[kWorldPart], 0.0);
  EXPECT_EQ(last.part[kPlanPart], 0.0);
  EXPECT_EQ(last.part[kQueuePart], 0.0);
  EXPECT_NEAR(sum(last), last.total, 1e-12);
  EXPECT_NEAR(log.redraw().p50, 0.049, 1e-12);

  // never redrawn: only the latency counts
  plan.id = 8;
  log.plan(contact_taken_at(0.14, 0.0), plan, 0.0);
  log.follow({8, 5600, 5600, -1}, device);
  EXPECT_NEAR(log.last()->total, 0.0, 1e-12);
  EXPECT_EQ(log.total().n, 2u);
  EXPECT_EQ(log.redraw().n, 1u);
}

TEST(LatencyLog, PartsOfAClockedPlanAddUp) {
  PipelineSettings settings;
  settings.devices.of<SimulatedArraySettings>().queue_blocks = 3;
  SimulatedArray device(settings.devices.of<SimulatedArraySettings>(), usx_array(), Medium{});
  PlanStage plans(settings, 1, 1.0, device.info(), nullptr);  // a silent source for the device
  ASSERT_EQ(device.start(plans.emitter()), DeviceStatus::Running);
  device.stop();  // its schedule stays, without further shifts
  // the run began half a second before the device; its hands were sampled 2 ms late, and the
  // tracker's frame had arrived 1 ms after the step was due
  const double run_start = device.play_time(0) - 0.5;
  WorldFrame contact = contact_taken_at(0.6, 0.0);
  contact.due = 0.598;
  contact.arrival = 0.599;
  PlanFrame plan;
  plan.id = 1;
  plan.start = 0.605;
  plan.plan_time = 0.002;
  plan.lift_time = 0.0005;
  LatencyLog log(true);
  log.plan(contact, plan, run_start);
  log.follow({1, 4480, 4600, -1}, device);
  const Latency& last = log.last().value();
  EXPECT_EQ(last.part[kFrameWait], 0.0);
  EXPECT_NEAR(last.part[kLateStart], 0.001, 1e-12);
  EXPECT_NEAR(last.part[kHandPart], 0.001, 1e-12);
  EXPECT_NEAR(last.part[kWorldPart], 0.003, 1e-12);
  EXPECT_NEAR(last.part[kHandOver], 0.001, 1e-12);
  EXPECT_NEAR(last.part[kPlanPart], 0.002, 1e-12);
  EXPECT_NEAR(last.part[kLiftPart], 0.0005, 1e-12);
  const double known = device.ask_time(4480) - run_start, asked = device.ask_time(4600) - run_start,
               leaves = device.play_time(4600) - run_start;
  EXPECT_NEAR(last.part[kBlockWait], known - 0.6075, 1e-9);
  EXPECT_NEAR(last.part[kLapWait], asked - known, 1e-9);
  EXPECT_NEAR(last.part[kQueuePart], leaves - asked, 1e-9);
  EXPECT_NEAR(asked - known, 0.003, 1e-9);
  EXPECT_GE(leaves - asked, 0.003 - 1e-9);
  EXPECT_NEAR(last.total, leaves - 0.599, 1e-9);
  EXPECT_NEAR(sum(last), last.total, 1e-9);
}

TEST(LatencyLog, NamesEachPartOnce) {
  std::set<std::string> names;
  for (int part = 0; part < kLatencyParts; ++part) names.insert(latency_part_name(part));
  EXPECT_EQ(names.size(), static_cast<std::size_t>(kLatencyParts));
}

/// Hands of constant age.
class OldHand final : public HandSource {
 public:
  OldHand(std::unique_ptr<HandSource> hand, double age) : hand_(std::move(hand)), age_(age) {}
  void sample(double time, HandFrame& out) override {
    hand_->sample(time, out);
    out.age = age_;
  }

 private:
  std::unique_ptr<HandSource> hand_;
  double age_;
};

class NoObserver final : public RunObserver {
 public:
  bool on_plan(const WorldFrame&, const PlanFrame&) override { return true; }
  bool on_progress(double) override { return true; }
};

RunSummary run_with(RunMode mode, double age, SwitchAt switch_at) {
  PipelineSettings settings;
  settings.fluid.cells = 32;
  settings.fluid_pressure.offset = settings.fluid.width / 32;
  settings.devices.of<SimulatedArraySettings>().realtime = mode == RunMode::RealTime;
  settings.scripted_hand.period = 5.0;
  settings.emit.switch_at = switch_at;
  Pipeline pipeline(settings, std::make_unique<OldHand>(
                                  make_scripted_hand(settings.scripted_hand, settings.track), age));
  NoObserver observer;
  return run(pipeline, settings, {2.0, mode}, observer);
}

void expect_means_add_up(const RunSummary& s) {
  double parts = 0.0;
  for (const Summary& part : s.latency_parts) {
    EXPECT_EQ(part.n, s.latency.n);
    parts += part.mean;
  }
  EXPECT_NEAR(parts, s.latency.mean, 1e-9);
}

TEST(RunLatency, SteppedRunsCountOnlyTheAgeAndTheLap) {
  const RunSummary young = run_with(RunMode::Stepped, 0.0, SwitchAt::Lap),
                   old = run_with(RunMode::Stepped, 0.003, SwitchAt::Lap);
  ASSERT_GT(young.latency.n, 10u);
  expect_means_add_up(old);
  EXPECT_NEAR(old.latency.mean, young.latency.mean + 0.003, 1e-9);
  EXPECT_NEAR(old.redraw.mean, young.redraw.mean + 0.003, 1e-9);
  for (int part = 0; part < kLatencyParts; ++part) {
    const Summary& s = old.latency_parts[static_cast<std::size_t>(part)];
    if (part == kFrameWait) {
      EXPECT_NEAR(s.max, 0.003, 1e-9);
      EXPECT_NEAR(s.mean, 0.003, 1e-9);
    } else if (part != kLapWait) {
      EXPECT_NEAR(s.max, 0.0, 1e-9) << latency_part_name(part);
    }
  }
  EXPECT_GT(old.latency_parts[kLapWait].max, 0.002);
}

TEST(RunLatency, SwitchNowDoesNotWaitForLaps) {
  const RunSummary s = run_with(RunMode::Stepped, 0.0, SwitchAt::Now);
  ASSERT_GT(s.latency.n, 10u);
  EXPECT_NEAR(s.latency.p50, 0.0, 1e-9);
  EXPECT_GT(s.emit.laps_cut, 10);
}

TEST(RunLatency, PartsOfARealTimeRunAddUp) {
  const RunSummary s = run_with(RunMode::RealTime, 0.003, SwitchAt::Lap);
  ASSERT_GT(s.latency.n, 0u);
  expect_means_add_up(s);
  EXPECT_GE(s.latency_parts[kQueuePart].mean, 3e-3 - 1e-9);
  EXPECT_GT(s.latency_parts[kWorldPart].mean, 0.0);
  EXPECT_GT(s.latency_parts[kPlanPart].mean, 0.0);
}

}  // namespace
}  // namespace prostm
