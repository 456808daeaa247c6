#include "prostm/device/segment_stream.hpp"

#include <gtest/gtest.h>

#include "prostm/device/simulated/simulated_array.hpp"

namespace prostm {
namespace {

/// A source whose samples carry their index.
class Counted final : public SampleSource {
 public:
  int foci() const override { return 2; }
  void fill(std::int64_t first, std::span<FocusSample> out) noexcept override {
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = {Eigen::Vector3f(static_cast<float>(first) + static_cast<float>(i / 2), 0, 0.2F),
                0.5F};
  }
};

std::unique_ptr<SimulatedArray> array(bool realtime) {
  SimulatedArraySettings settings;
  settings.realtime = realtime;
  return std::make_unique<SimulatedArray>(settings, usx_array(), Medium{});
}

TEST(SegmentStream, PlaysAStreamBlockByBlockInSteps) {
  SegmentStream device(array(false));
  Counted source;
  ASSERT_EQ(device.start(source), DeviceStatus::Running);
  EXPECT_EQ(device.samples(), 0);
  device.pull(25);
  device.pull(25);
  EXPECT_EQ(device.samples(), 50 * 40);
  EXPECT_EQ(device.stats().blocks, 51) << "one block is loaded ahead";
  const std::vector<FocusSample> played = device.played()->read_back(0, 50 * 40);
  for (std::size_t i = 0; i < played.size(); ++i)
    ASSERT_EQ(played[i].p_D.x(), static_cast<float>(i / 2)) << i;
  EXPECT_EQ(device.play_time(400), 0.01);
}

TEST(SegmentStream, KeepsTimeAndPlaysEveryBlockInOrder) {
  SegmentStream device(array(true));
  Counted source;
  ASSERT_EQ(device.start(source), DeviceStatus::Running);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  const std::int64_t played = device.samples();
  EXPECT_GT(played, 100);
  EXPECT_GE(device.stats().blocks * 40, played);
  EXPECT_LT(device.ask_time(4000), device.play_time(4000));
  device.stop();
  EXPECT_EQ(device.status(), DeviceStatus::Idle);
  // blocks are complete and in order
  const std::int64_t n = dynamic_cast<const SimulatedArray&>(*device.played()).samples() / 40 * 40;
  const std::vector<FocusSample> back = device.played()->read_back(0, n);
  float block = 0.0F;
  for (std::size_t i = 0; i < back.size(); i += 80) {
    EXPECT_GE(back[i].p_D.x(), block);
    block = back[i].p_D.x();
    EXPECT_EQ(back[i + 79].p_D.x(), block + 39.0F);
  }
}

TEST(SegmentStream, RejectsInvalidCallsWithASentence) {
  Counted source;
  auto broken = array(false);
  SimulatedFaults faults;
  faults.refuse = true;
  broken->set_faults(faults);
  SegmentStream refusing(std::move(broken));
  EXPECT_EQ(refusing.start(source), DeviceStatus::Refused);
  EXPECT_NE(refusing.problem().find("refuses"), std::string::npos);

  auto failing = array(false);
  SimulatedArray& inner = *failing;
  SegmentStream lost(std::move(failing));
  ASSERT_EQ(lost.start(source), DeviceStatus::Running);
  lost.pull(3);
  inner.set_faults(faults);
  lost.pull(1);
  EXPECT_EQ(lost.status(), DeviceStatus::Vanished);
  EXPECT_NE(lost.problem().find("refuses"), std::string::npos);

  SegmentStream device(array(false));
  ASSERT_EQ(device.start(source), DeviceStatus::Running);
  EXPECT_EQ(device.load_segment(std::vector<FocusSample>(80), 2), DeviceStatus::Refused);
  EXPECT_NE(device.problem().find("stop it first"), std::string::npos);
}

}  // namespace
}  // namespace prostm
