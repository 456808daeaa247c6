// A device unknown to prostm, in the whole pipeline: an example of how to write one.
#include <gtest/gtest.h>

#include <algorithm>

#include "prostm/pipeline/runner.hpp"

namespace prostm {
namespace {

/// Loads segments of 20 ms at 4 kHz, with one intensity for all focal points.
class OtherDevice final : public Device {
 public:
  OtherDevice(bool keeps_time, std::vector<FocusSample>& kept) : kept_(kept) {
    info_ = {.name = "other", .sample_rate = 4e3, .block_samples = 80, .max_foci = 4};
    info_.loads_segments = true;
    info_.decimation = 10;
    info_.keeps_time = keeps_time;
  }
  const DeviceInfo& info() const override { return info_; }
  DeviceStatus status() const override { return DeviceStatus::Running; }
  std::string problem() const override { return {}; }
  DeviceStatus start(SampleSource&) override { return DeviceStatus::Refused; }
  void stop() override {}
  DeviceStatus load_segment(std::span<const FocusSample> samples, int) override {
    kept_.insert(kept_.end(), samples.begin(), samples.end());
    return DeviceStatus::Running;
  }
  DeviceStats stats() const override { return {}; }
  std::int64_t samples() const override { return 0; }
  double play_time(std::int64_t) const override { return 0.0; }

 private:
  DeviceInfo info_;
  std::vector<FocusSample>& kept_;
};

struct Onlooker final : RunObserver {
  bool on_plan(const WorldFrame&, const PlanFrame&) override { return true; }
  bool on_progress(double) override { return true; }
};

TEST(OtherDevice, IsPlayedInSteppedAndRealTimeRuns) {
  PipelineSettings settings;
  settings.fluid.cells = 32;
  for (const RunMode mode : {RunMode::Stepped, RunMode::RealTime}) {
    std::vector<FocusSample> played;
    Onlooker onlooker;
    Pipeline pipeline(settings, make_scripted_hand(settings.scripted_hand, settings.track),
                      std::make_shared<Mute>(),
                      std::make_unique<OtherDevice>(mode == RunMode::RealTime, played));
    const RunSummary summary = run(pipeline, settings, {3.0, mode}, onlooker);
    const auto sounds = [](const FocusSample& s) { return s.intensity > 0.3F; };
    EXPECT_TRUE(std::ranges::any_of(played, sounds) && summary.device.blocks > 130);
    EXPECT_TRUE(summary.latency.n > 0 && summary.limited_samples == 0);
  }
}

TEST(OtherDevice, ARealTimeDeviceIsRejectedInASteppedRun) {
  std::vector<FocusSample> kept;
  const OtherDevice clocked(true, kept), stepped(false, kept);
  for (const RunMode mode : {RunMode::Stepped, RunMode::AsFastAsPossible}) {
    EXPECT_NE(mode_problem(clocked.info(), mode).find("without --as-fast-as-possible"),
              std::string::npos);
    EXPECT_EQ(mode_problem(stepped.info(), mode), "");
  }
  EXPECT_EQ(mode_problem(clocked.info(), RunMode::RealTime), "");
}

}  // namespace
}  // namespace prostm
