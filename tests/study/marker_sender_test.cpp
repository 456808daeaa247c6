#include "prostm/study/live/marker_sender.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "prostm/acoustics/array/array.hpp"
#include "prostm/device/simulated/simulated_array.hpp"
#include "study/study_support.hpp"
#include "support/eventually.hpp"

namespace prostm {
namespace {

/// A focal point that is active while it is not muted.
class Tone final : public SampleSource {
 public:
  Tone(std::shared_ptr<Mute> mute, SoundWatch& watch) : mute_(std::move(mute)), watch_(watch) {}
  int foci() const override { return 1; }
  void fill(std::int64_t first, std::span<FocusSample> out) noexcept override {
    for (FocusSample& sample : out) sample.intensity = mute_->on() ? 0.0F : 0.5F;
    watch_.look(first, out, 1);
  }

 private:
  const std::shared_ptr<Mute> mute_;
  SoundWatch& watch_;
};

/// Waits until this many more blocks were requested, at any speed.
void play(const Device& device, std::int64_t blocks) {
  const std::int64_t end = device.stats().blocks + blocks;
  ASSERT_TRUE(test::eventually([&] { return device.stats().blocks >= end; }));
}

/// An array that plays a tone while it is not muted, and its markers.
class MarkersOfATone : public testing::Test {
 protected:
  void TearDown() override { device.stop(); }

  const Protocol protocol = test::study_protocol();
  const std::shared_ptr<Mute> mute = std::make_shared<Mute>();
  SimulatedArray device{{}, usx_array(), Medium()};
  SoundWatch watch{mute, device.info().sample_rate};
  Tone tone{mute, watch};
  MarkerSender sender{{}, protocol, {3, 2}, device, watch};
};

TEST_F(MarkersOfATone, SendsAMarkerWhenItsSampleLeavesTheArrayAndDeliversAll) {
  mute->set(MuteReason::Study, true);
  constexpr std::uint32_t kTrials = 5;
  for (int start = 1; start <= 2; ++start) {
    ASSERT_EQ(device.start(tone), DeviceStatus::Running);
    for (std::uint32_t trial = 1; trial <= kTrials; ++trial) {
      sender.present({trial, trial, 0}, StudyPlayed{7.0, 0.02, 0});
      mute->set(MuteReason::Study, false);
      play(device, 3);
      mute->set(MuteReason::Study, true);
      play(device, 15);
    }
    ASSERT_TRUE(test::eventually([&] { return watch.is_read(); }));
    device.stop();
    watch.end();
  }
  sender.stop();
  Marker marker;
  std::int64_t last = -1;
  for (int i = 0; i < 4 * static_cast<int>(kTrials); ++i) {
    ASSERT_TRUE(sender.next(marker)) << i;
    EXPECT_EQ(marker.sequence, i + 1);
    EXPECT_EQ(marker.on, i % 2 == 0);
    const auto trial = static_cast<std::uint32_t>(i) / 2 % kTrials + 1;
    EXPECT_EQ(marker.presentation, (Presentation{trial, trial, 0}));
    EXPECT_EQ(marker.stream, i < 2 * static_cast<int>(kTrials) ? 1 : 2);
    if (i == 2 * static_cast<int>(kTrials)) last = -1;
    EXPECT_GT(marker.sample, last);
    last = marker.sample;
    EXPECT_FALSE(marker.emission) << "a hidden condition has no speed";
    ASSERT_TRUE(marker.played);
    EXPECT_GE(marker.sent, *marker.played);
    EXPECT_LT(marker.sent, *marker.played + 60.0);
    EXPECT_EQ(sender.line(marker)["kind"], "marker");
    EXPECT_EQ(sender.line(marker)["run"], 2);
  }
  EXPECT_FALSE(sender.next(marker));
}

TEST_F(MarkersOfATone, CountsTheSoundsOfAPresentation) {
  sender.present({1, 1, 0}, {});
  ASSERT_EQ(device.start(tone), DeviceStatus::Running);
  for (int part = 1; part <= 3; ++part) {
    mute->set(MuteReason::NoHand, false);  // a hand that leaves and returns
    play(device, 3);
    mute->set(MuteReason::NoHand, true);
    play(device, 15);
  }
  ASSERT_TRUE(test::eventually([&] { return watch.is_read(); }));
  device.stop();
  sender.stop();
  Marker marker;
  for (int i = 0; i < 6; ++i) {
    ASSERT_TRUE(sender.next(marker)) << i;
    EXPECT_EQ(marker.part, i / 2 + 1);
    EXPECT_EQ(code_of(marker), marker.on ? (i == 0 ? 1 : 3) : 2);
  }
}

TEST_F(MarkersOfATone, ReportsHowThePresentationsNewestPlanIsPlayed) {
  mute->set(MuteReason::Study, true);
  ASSERT_EQ(device.start(tone), DeviceStatus::Running);
  Marker on, off;
  const auto next = [&](Marker& marker) {
    return test::eventually([&] { return sender.next(marker); });
  };
  for (std::uint32_t trial = 1; trial <= 3; ++trial) {
    sender.present({trial, trial, 1}, StudyPlayed{1.0 * trial, 0.02, 0});
    mute->set(MuteReason::Study, false);
    ASSERT_TRUE(next(on));
    sender.tell(StudyPlayed{10.0 * trial, 0.03, 2});
    mute->set(MuteReason::Study, true);
    ASSERT_TRUE(next(off));
    ASSERT_TRUE(on.emission && off.emission);
    EXPECT_EQ(on.emission->speed, 1.0 * trial);
    EXPECT_EQ(off.emission->speed, 10.0 * trial);
    EXPECT_EQ(off.emission->changed, 2);
  }
  device.stop();
}

TEST(MarkerSender, AMarkerHasNoTimeIfTheDeviceHasStopped) {
  const Protocol protocol = test::study_protocol();
  const auto mute = std::make_shared<Mute>();
  SimulatedArray device({}, usx_array(), Medium());
  SoundWatch watch(mute, device.info().sample_rate);
  std::vector<FocusSample> loud(40);
  for (FocusSample& sample : loud) sample.intensity = 0.5F;
  watch.look(0, loud, 1);
  watch.end();
  MarkerSender sender({}, protocol, {1, 1}, device, watch);
  sender.stop();
  Marker marker;
  for (const std::int64_t sample : {0, 40}) {
    ASSERT_TRUE(sender.next(marker));
    EXPECT_EQ(marker.sample, sample);
    EXPECT_FALSE(marker.played);
  }
}

}  // namespace
}  // namespace prostm
