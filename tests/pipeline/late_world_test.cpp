// Steps that start late, in real time.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "prostm/pipeline/runner.hpp"

namespace prostm {
namespace {

/// A world without pressure; every `each`th step takes long.
class SlowWorld final : public World, public PressureSource {
 public:
  SlowWorld(std::chrono::milliseconds stall, int each) : stall_(stall), each_(each) {}

  const GridShape& grid() const override { return grid_; }
  double full_scale_pressure() const override { return 1.0; }
  void meet(const HandRaster&) noexcept override {
    if (++steps_ % each_ == 0) std::this_thread::sleep_for(stall_);
  }
  const PressureSource& pressure(double) noexcept override { return *this; }
  void sample(std::span<const Vec3>, const Vec3&, std::span<double> out) const noexcept override {
    std::fill(out.begin(), out.end(), 0.0);
  }

 private:
  const std::chrono::milliseconds stall_;
  const int each_;
  int steps_ = 0;
  GridShape grid_{16, 16, 16, 0.36 / 16, Vec3(-0.18, -0.18, 0.0)};
};

class Nobody final : public RunObserver {
 public:
  bool on_plan(const WorldFrame&, const PlanFrame&) override { return true; }
  bool on_progress(double) override { return true; }
};

/// Skipped steps in a run of 15 in which every `each`th stalls; by default one in the middle.
std::int64_t skipped_after(std::chrono::milliseconds stall, int each = 8) {
  PipelineSettings settings;
  Pipeline pipeline(settings, make_scripted_hand(settings.scripted_hand, settings.track),
                    std::make_shared<Mute>(), nullptr, std::make_unique<SlowWorld>(stall, each));
  Nobody nobody;
  const RunSummary s = run(pipeline, settings, {0.3, RunMode::RealTime}, nobody);
  EXPECT_EQ(s.world_steps + s.skipped_world_steps, 15);
  return s.skipped_world_steps;
}

TEST(LateWorld, CatchesUpAfterADelayOfLessThanThreeSteps) {
  for (const int stall : {48, 70}) {
    // the machine itself may wake a thread late
    std::int64_t fewest = 15;
    for (int attempt = 0; attempt < 5 && fewest > 0; ++attempt)
      fewest = std::min(fewest, skipped_after(std::chrono::milliseconds(stall)));
    EXPECT_EQ(fewest, 0) << stall;
  }
}

TEST(LateWorld, SkipsStepsWhenEachTakesTooLong) {
  // 25 ms instead of 20: a step is skipped once two in a row start later and later
  EXPECT_GE(skipped_after(std::chrono::milliseconds(25), 1), 1);
}

TEST(LateWorld, SkipsStepsRatherThanLagBehindTheClock) {
  EXPECT_GE(skipped_after(std::chrono::milliseconds(90)), 3);
}

}  // namespace
}  // namespace prostm
