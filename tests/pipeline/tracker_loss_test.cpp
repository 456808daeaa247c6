/// The array's output when the tracker is disconnected, freezes, or has no confidence in its hands.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "pipeline/simulated.hpp"
#include "prostm/core/stage_timer.hpp"
#include "prostm/device/simulated/simulated_array.hpp"
#include "prostm/pipeline/runner.hpp"
#include "prostm/track/live/live_tracker.hpp"
#include "support/eventually.hpp"

namespace prostm {
namespace {

using test::eventually;

enum class Mode : std::uint8_t { Well, Cut, Frozen, Unsure };

/// A tracker at 100 Hz with a hand at rest, except for its noise.
class StandIn final : public LiveTracker {
 public:
  StandIn(const std::atomic<Mode>& mode, const PipelineSettings& s) : mode_(mode) {
    make_scripted_hand(s.scripted_hand, s.track)->sample(0.0, frame_);
  }
  bool next(HandFrame& frame) override {
    const double now = steady_now();
    if (!connected() || now - frame_.time < 0.01) return false;
    const Mode mode = mode_;
    frame_.time = now;
    Hand& hand = frame_.hands.at(0);
    hand.confidence = mode == Mode::Unsure ? 0.05 : 1.0;
    if (mode != Mode::Frozen) hand.position[kMiddleTip].x() += noise_ = -noise_;
    frame = frame_;
    return true;
  }
  bool connected() const noexcept override { return mode_ != Mode::Cut; }
  TrackerStatus status() const override {
    TrackerStatus status;
    status.connected = connected();
    return status;
  }

 private:
  const std::atomic<Mode>& mode_;
  HandFrame frame_;
  double noise_ = 3e-5;  // [m]
};

/// Hands that record the number of samples played when they disappear.
class Noted final : public HandSource {
 public:
  explicit Noted(std::unique_ptr<HandSource> hands) : hands_(std::move(hands)) {}
  void sample(double time, HandFrame& out) override {
    hands_->sample(time, out);
    if (!out.hands.empty()) {
      gone_at = -1;
    } else if (gone_at < 0) {
      gone_at = device != nullptr ? device->samples() : 0;
    }
  }
  std::optional<TrackerStatus> tracker_status() const override { return hands_->tracker_status(); }

  const SimulatedArray* device = nullptr;
  std::atomic<std::int64_t> gone_at{-1};  // sample, −1 while there is a hand

 private:
  std::unique_ptr<HandSource> hands_;
};

class UntilToldToStop final : public RunObserver {
 public:
  bool on_plan(const WorldFrame&, const PlanFrame&) override { return !stop; }
  bool on_progress(double) override { return !stop; }
  std::atomic<bool> stop{false};
};

class TrackerLoss : public testing::TestWithParam<Method> {};
INSTANTIATE_TEST_SUITE_P(Pipeline, TrackerLoss, testing::Values(Method::ProStm, Method::Am),
                         [](const auto& method) {
                           return std::string(method.param == Method::Am ? "am" : "pro_stm");
                         });

TEST_P(TrackerLoss, TheOutputFadesWithin50MillisecondsAndComesBackWithTheHand) {
  PipelineSettings settings;
  settings.method = GetParam();
  settings.fluid.cells = 32;
  set_live_budget(settings);
  settings.scripted_hand.still = true;
  settings.track.freeze_time = 0.1;
  settings.devices.of<SimulatedArraySettings>().history = 30.0;
  std::atomic<Mode> mode{Mode::Well};
  auto noted = std::make_unique<Noted>(
      make_live_hand(std::make_unique<StandIn>(mode, settings), settings.track));
  Noted& hands = *noted;
  Pipeline pipeline(settings, std::move(noted));
  const SimulatedArray& device = test::simulated(pipeline);
  hands.device = &device;
  UntilToldToStop observer;
  std::thread thread([&] { run(pipeline, settings, {3600.0, RunMode::RealTime}, observer); });

  const auto loudest = [&](std::int64_t first, std::int64_t last) {
    float most = 0.0F;
    for (const FocusSample& s : device.read_back(first, last - first))
      most = std::max(most, s.intensity);
    return most;
  };
  const auto sounds = [&] {
    const std::int64_t n = device.samples();
    return n > 400 && loudest(n - 400, n) > 0.1F;
  };
  for (const Mode fault : {Mode::Cut, Mode::Frozen, Mode::Unsure}) {
    SCOPED_TRACE(static_cast<int>(fault));
    mode = Mode::Well;
    if (!eventually([&] { return hands.gone_at < 0 && sounds(); })) {
      ADD_FAILURE() << "the hand is never rendered";
      break;
    }
    mode = fault;
    EXPECT_TRUE(eventually([&] { return hands.gone_at >= 0; }));
    // silent 50 ms after the step without a hand, and from then on
    const std::int64_t gone = hands.gone_at, silent = gone + 2000, end = gone + 8000;
    EXPECT_TRUE(eventually([&] { return device.samples() >= end; }));
    EXPECT_EQ(loudest(silent, end), 0.0F);
    EXPECT_EQ(hands.gone_at, gone);
  }
  const TrackerStatus status = *hands.tracker_status();
  EXPECT_GT(status.frozen, 0);
  EXPECT_GT(status.unsure, 0);

  // throughout the run there are fades instead of cuts
  const std::int64_t n = device.samples();
  const auto foci = static_cast<std::size_t>(device.foci());
  const std::vector<FocusSample> played = device.read_back(0, n);
  float slew = 0.0F;
  for (std::size_t i = foci; i < played.size(); ++i)
    slew = std::max(slew, std::abs(played[i].intensity - played[i - foci].intensity));
  EXPECT_LE(slew, 1.0F / 40.0F + 1e-6F);
  observer.stop = true;
  thread.join();
}

}  // namespace
}  // namespace prostm
