/// How runs end: if anything fails on any thread, all threads end, the output fades, and the
/// failure is reported.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "pipeline/simulated.hpp"
#include "prostm/device/simulated/simulated_array.hpp"
#include "prostm/pipeline/detail/recent_rate.hpp"
#include "prostm/pipeline/runner.hpp"
#include "support/eventually.hpp"

namespace prostm {
namespace {

constexpr double kTooLong = 3600.0;  // later than any test runs [s]

PipelineSettings settings_for(RunMode mode) {
  PipelineSettings s;
  s.fluid.cells = 32;
  s.scripted_hand.still = true;
  s.plan.preset = Preset::Fast;
  s.devices.of<SimulatedArraySettings>().realtime = mode == RunMode::RealTime;
  return s;
}

/// The scripted hand, which fails at a set time.
class FailingHand final : public HandSource {
 public:
  FailingHand(const PipelineSettings& s, double at)
      : hand_(make_scripted_hand(s.scripted_hand, s.track)), at_(at) {}
  void sample(double time, HandFrame& out) override {
    if (time > at_) throw std::runtime_error("the hand failed");
    hand_->sample(time, out);
  }

 private:
  std::unique_ptr<HandSource> hand_;
  const double at_;
};

/// Acts at the first plan with output: throws, or stops the run.
class Ender final : public RunObserver {
 public:
  enum class By { Throwing, ThrowingInProgress, Stopping, Nothing };
  explicit Ender(By by) : by_(by) {}
  bool on_plan(const WorldFrame&, const PlanFrame& plan) override {
    EXPECT_FALSE(ended_) << "no call after the end";
    sounding_ += plan.status == PlanStatus::Planned ? 1 : 0;
    if (sounding_ < 3) return true;
    if (by_ == By::Throwing) end();
    return by_ != By::Stopping;
  }
  bool on_progress(double) override {
    EXPECT_FALSE(ended_);
    if (by_ == By::ThrowingInProgress && sounding_ >= 3) end();
    return true;
  }

 private:
  [[noreturn]] void end() {
    ended_ = true;
    throw std::runtime_error("the observer failed");
  }
  const By by_;
  bool ended_ = false;
  int sounding_ = 0;
};

std::string what(const RunSummary& summary) {
  try {
    if (summary.failure) std::rethrow_exception(summary.failure);
    return "";
  } catch (const std::exception& error) {
    return error.what();
  }
}

/// Checks that the device is stopped, and that its output was on, fell silent without a jump,
/// and stayed silent.
void expect_faded(const Pipeline& made) {
  const SimulatedArray& device = test::simulated(const_cast<Pipeline&>(made));
  EXPECT_EQ(device.status(), DeviceStatus::Idle);
  const std::int64_t all = device.stats().blocks * device.info().block_samples;
  ASSERT_TRUE(test::eventually([&] { return device.samples() == all; }));
  const auto foci = static_cast<std::size_t>(device.foci());
  const std::int64_t n = std::min<std::int64_t>(all, 40'000);
  const std::vector<FocusSample> played = device.read_back(all - n, n);
  constexpr float kLargestFall = 1.001F / 40.0F;  // in intensity per sample
  float loudest = 0.0F, largest_fall = 0.0F;
  for (std::size_t i = foci; i < played.size(); ++i) {
    loudest = std::max(loudest, played[i].intensity);
    largest_fall = std::max(largest_fall, played[i - foci].intensity - played[i].intensity);
  }
  EXPECT_GT(loudest, 0.05F);
  EXPECT_LE(largest_fall, kLargestFall);
  for (std::size_t i = played.size() - foci * 40; i < played.size(); ++i)
    EXPECT_EQ(played[i].intensity, 0.0F);
}

class RunEnds : public testing::TestWithParam<RunMode> {
 protected:
  RunSummary run_until(Ender::By by) {
    Ender observer(by);
    return run(pipeline_, settings_, {kTooLong, GetParam()}, observer);
  }
  const PipelineSettings settings_ = settings_for(GetParam());
  Pipeline pipeline_{settings_, make_scripted_hand(settings_.scripted_hand, settings_.track)};
};

INSTANTIATE_TEST_SUITE_P(Modes, RunEnds,
                         testing::Values(RunMode::RealTime, RunMode::AsFastAsPossible,
                                         RunMode::Stepped),
                         [](const auto& mode) -> std::string {
                           if (mode.param == RunMode::RealTime) return "real_time";
                           return mode.param == RunMode::Stepped ? "stepped"
                                                                 : "as_fast_as_possible";
                         });

TEST_P(RunEnds, WhenItsObserverThrows) {
  const RunSummary summary = run_until(Ender::By::Throwing);
  EXPECT_EQ(what(summary), "the observer failed");
  EXPECT_TRUE(summary.stopped);
  EXPECT_GE(summary.plans, 3);
  if (GetParam() == RunMode::RealTime) expect_faded(pipeline_);
  EXPECT_EQ(pipeline_.device().status(), DeviceStatus::Idle);
}

TEST_P(RunEnds, WhenItsObserverThrowsBetweenPlans) {
  EXPECT_EQ(what(run_until(Ender::By::ThrowingInProgress)), "the observer failed");
}

TEST_P(RunEnds, WhenItIsStopped) {
  const RunSummary summary = run_until(Ender::By::Stopping);
  EXPECT_EQ(what(summary), "");
  EXPECT_TRUE(summary.stopped);
  if (GetParam() == RunMode::RealTime) expect_faded(pipeline_);
}

TEST_P(RunEnds, WhenTheHandsThrow) {
  Pipeline pipeline(settings_, std::make_unique<FailingHand>(settings_, 0.3));
  Ender observer(Ender::By::Nothing);
  const RunSummary summary = run(pipeline, settings_, {kTooLong, GetParam()}, observer);
  EXPECT_EQ(what(summary), "the hand failed");
  // in real time a late world skips its steps
  if (GetParam() != RunMode::RealTime) EXPECT_GE(summary.world_steps, 1);
  EXPECT_EQ(pipeline.device().status(), DeviceStatus::Idle);
}

TEST_P(RunEnds, WhenTheDeviceVanishes) {
  SimulatedFaults faults;
  faults.vanish_after = 300;
  test::simulated(pipeline_).set_faults(faults);
  EXPECT_EQ(what(run_until(Ender::By::Nothing)),
            "The simulated array vanished after 300 blocks, as requested; start it again.");
}

TEST(RunEnd, AModulationFadesToo) {
  PipelineSettings settings = settings_for(RunMode::RealTime);
  settings.method = Method::Am;
  settings.emit.am_frequency = 25.0;
  Pipeline pipeline(settings, make_scripted_hand(settings.scripted_hand, settings.track));
  Ender observer(Ender::By::Throwing);
  EXPECT_EQ(what(run(pipeline, settings, {kTooLong, RunMode::RealTime}, observer)),
            "the observer failed");
  expect_faded(pipeline);
}

TEST(RecentRate, CoversTheLastSecondOrTheShorterHistory) {
  RecentRate rate;
  EXPECT_EQ(rate.rate(), 0.0);
  rate.add(1000.0, 7);
  EXPECT_EQ(rate.rate(), 0.0);
  for (int i = 1; i <= 500; ++i) rate.add(1000.0 + 0.02 * i, 7 + i);
  EXPECT_NEAR(rate.rate(), 50.0, 1e-6);
  for (int i = 1; i <= 500; ++i) rate.add(1010.0 + 0.015 * i, 507);
  EXPECT_EQ(rate.rate(), 0.0);
}

}  // namespace
}  // namespace prostm
