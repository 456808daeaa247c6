// The adapter's logic, against the stand-in of the SDK's interface.
#include <gmock/gmock.h>

#include <cmath>
#include <thread>

#include "support/eventually.hpp"
#include "support/heap_guard.hpp"
#include "ultraleap/listening.hpp"

namespace prostm {
namespace {

using test::Listener;
using test::Numbered;
using test::setup_of;
using testing::AllOf;
using testing::HasSubstr;
namespace stand_in = test::stand_in;

constexpr int kFade = 16;  // samples of 1 ms at 16 kHz

/// Stepped manually; the array accepts 3 points at 16 kHz.
class UltraleapArray : public testing::Test {
 protected:
  void SetUp() override {
    stand_in::reset({stand_in::Array{}});
    stand_in::set_manual(true);
  }
  void TearDown() override {
    EXPECT_EQ(stand_in::violations(), 0) << stand_in::last_violation();
    EXPECT_EQ(stand_in::emitters(), 0);
  }
};

std::string refusal(const DeviceSetup& setup) {
  try {
    make_ultraleap(setup);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "not refused";
}

TEST_F(UltraleapArray, UsesTheRateForItsNumberOfPoints) {
  const double rates[] = {40e3, 20e3, 16e3, 13333.3333, 10e3, 8e3};
  const int decimations[] = {1, 2, 3, 3, 4, 5};
  for (int foci = 1; foci <= 6; ++foci) {
    const auto device = make_ultraleap(setup_of(foci));
    const DeviceInfo& info = device->info();
    EXPECT_NEAR(info.sample_rate, rates[foci - 1], 0.01);
    EXPECT_EQ(info.decimation, decimations[foci - 1]);
    EXPECT_GE(info.emission_rate(), 40e3 * (1.0 - 1e-6));
    EXPECT_LT(info.emission_rate(), 80e3);
    EXPECT_EQ(info.block_samples, std::lround(rates[foci - 1] / 1000.0));
    EXPECT_EQ(info.max_foci, foci);
    EXPECT_TRUE(info.intensity_per_focus && info.streams && info.keeps_time);
    // the registry uses that rate from then on
    EXPECT_EQ(ultraleap_info(setup_of(foci)).sample_rate, info.sample_rate);
  }
}

TEST_F(UltraleapArray, NeverExceedsTheRateOfTheArray) {
  stand_in::Array array;
  array.emitter_follows = false;
  stand_in::reset({array});
  stand_in::set_manual(true);
  EXPECT_EQ(make_ultraleap(setup_of(3))->info().sample_rate, 16e3);
  EXPECT_EQ(make_ultraleap(setup_of(5))->info().sample_rate, 10e3);
}

TEST_F(UltraleapArray, DetectsThatCallbacksHaveStopped) {
  const auto device = make_ultraleap(setup_of(3));
  Numbered source(3);
  ASSERT_EQ(device->start(source), DeviceStatus::Running);
  stand_in::step(10);
  EXPECT_EQ(device->status(), DeviceStatus::Running);
  std::this_thread::sleep_for(std::chrono::milliseconds(1'100));
  EXPECT_EQ(device->status(), DeviceStatus::Running) << "this program may have been suspended";
  EXPECT_TRUE(test::eventually([&] { return device->status() == DeviceStatus::Vanished; }));
  EXPECT_THAT(device->problem(), HasSubstr("no samples for a second"));
  ASSERT_EQ(device->start(source), DeviceStatus::Running);
}

TEST_F(UltraleapArray, SetsEverySampleOnceAndInOrder) {
  for (const int foci : {1, 2, 3, 4}) {
    const auto device = make_ultraleap(setup_of(foci));
    Listener listener(60'000);
    Numbered source(foci);
    ASSERT_EQ(device->start(source), DeviceStatus::Running);
    stand_in::step(1'000);
    EXPECT_TRUE(source.in_order());
    const double rate = device->info().sample_rate;
    const auto heard = listener.heard();
    ASSERT_NEAR(static_cast<double>(heard.size()), rate, 1.0) << "a second";
    const auto fade = static_cast<std::size_t>(std::ceil(1e-3 * rate));
    EXPECT_LE(source.taken(), static_cast<std::int64_t>(heard.size() + fade) + 1)
        << "no more samples than needed";
    for (std::size_t i = 0; i < heard.size(); ++i) {
      for (int f = 0; f < foci; ++f) {
        const FocusSample given = Numbered::sample(static_cast<std::int64_t>(i), f);
        const FocusSample& got = heard[i].point[f];
        ASSERT_EQ(got.p_D, given.p_D) << i;
        if (i + 1 >= fade) {
          ASSERT_NEAR(got.intensity, given.intensity, 1e-6F) << i;
        } else {
          ASSERT_LE(got.intensity, given.intensity) << "the rise is a fade";
        }
      }
      if (i == 0) continue;
      ASSERT_NEAR((heard[i].time - heard[i - 1].time) * rate, 1.0, 1e-3);
    }
    EXPECT_EQ(device->stats().blocks, 1'000);
    EXPECT_EQ(device->stats().late_blocks, 0);
    EXPECT_EQ(device->stats().missed_blocks, 0);
    // times are those of the steady clock, and of the samples themselves
    const double last = static_cast<double>(heard.size()) - 1.0;
    EXPECT_NEAR(device->play_time(static_cast<std::int64_t>(last)), heard.back().time, 1e-3);
    device->stop();
    EXPECT_EQ(device->status(), DeviceStatus::Idle);
  }
}

TEST_F(UltraleapArray, AllocatesNothingInTheCallback) {
  const auto device = make_ultraleap(setup_of(3));
  Numbered source(3);
  ASSERT_EQ(device->start(source), DeviceStatus::Running);
  const test::HeapGuard guard;
  stand_in::step(200);
  EXPECT_EQ(guard.allocations(), 0U);
}

TEST_F(UltraleapArray, NamesTheProgramThatUsesTheArray) {
  stand_in::claim("MockDevice:USX", "Sensation Designer");
  EXPECT_THAT(refusal(setup_of(3)),
              AllOf(HasSubstr("'MockDevice:USX' is used by Sensation Designer"),
                    HasSubstr("end that program")));
  const DeviceFinding found = look_for_ultraleap(setup_of(3));
  EXPECT_FALSE(found.found);
  EXPECT_THAT(found.words, HasSubstr("used by Sensation Designer"));
  stand_in::claim("MockDevice:USX", "");
  {
    const auto device = make_ultraleap(setup_of(3));
    EXPECT_THAT(stand_in::owner("MockDevice:USX"), HasSubstr("prostm"));
  }
  EXPECT_EQ(stand_in::owner("MockDevice:USX"), "") << "released";
}

TEST_F(UltraleapArray, ReportsThatTheArrayIsGoneAndRestarts) {
  const auto device = make_ultraleap(setup_of(3));
  Numbered first(3), second(3);
  ASSERT_EQ(device->start(first), DeviceStatus::Running);
  stand_in::step(50);
  stand_in::disconnect("MockDevice:USX");
  EXPECT_EQ(device->status(), DeviceStatus::Vanished);
  EXPECT_THAT(device->problem(), HasSubstr("was disconnected: connect it"));
  // start() fails until the array is back
  EXPECT_EQ(device->start(second), DeviceStatus::Refused);
  EXPECT_THAT(device->problem(), HasSubstr("No Ultraleap array that streams was found"));
  stand_in::reconnect("MockDevice:USX");
  Listener listener(2'000);
  ASSERT_EQ(device->start(second), DeviceStatus::Running) << device->problem();
  stand_in::step(50);
  EXPECT_EQ(device->status(), DeviceStatus::Running);
  EXPECT_EQ(device->problem(), "");
  ASSERT_EQ(listener.heard().size(), 800U);
  EXPECT_EQ(listener.heard().back().point[1].p_D, Numbered::sample(799, 1).p_D);
}

TEST_F(UltraleapArray, FallsSilentIfTheArrayIsTakenOrFails) {
  const std::pair<void (*)(), const char*> ends[] = {
      {[] { stand_in::report_error("MockDevice:USX", 7); }, "reports an error (number 7)"},
      {[] { stand_in::end_service(); }, "service of the Ultraleap Haptics SDK has ended"}};
  for (const auto& [end, words] : ends) {
    stand_in::set_service(true);
    const auto device = make_ultraleap(setup_of(3));
    Listener listener(4'000);
    Numbered source(3);
    ASSERT_EQ(device->start(source), DeviceStatus::Running);
    stand_in::step(100);
    end();
    EXPECT_EQ(device->status(), DeviceStatus::Vanished);
    EXPECT_THAT(device->problem(), HasSubstr(words));
    stand_in::step(5);  // further callbacks get a fade, then silence
    const auto heard = listener.heard();
    ASSERT_EQ(heard.size(), 105U * 16U);
    for (std::size_t i = 1'600; i < heard.size(); ++i) {
      const float change = heard[i - 1].point[0].intensity - heard[i].point[0].intensity;
      ASSERT_LE(change, 1.0F / kFade + 1e-3F);
    }
    EXPECT_GT(heard[1'600].point[0].intensity, 0.0F);
    EXPECT_EQ(heard[1'600 + kFade].point[0].intensity, 0.0F);
    EXPECT_EQ(heard.back().point[2].intensity, 0.0F);
  }
}

TEST_F(UltraleapArray, ReportsThatAnotherProgramTookTheArray) {
  const auto device = make_ultraleap(setup_of(3));
  Numbered source(3);
  ASSERT_EQ(device->start(source), DeviceStatus::Running);
  stand_in::step(10);
  stand_in::rescind("MockDevice:USX", "another program");
  EXPECT_EQ(device->status(), DeviceStatus::Vanished);
  EXPECT_THAT(device->problem(), HasSubstr("was taken from this program"));
  EXPECT_EQ(device->start(source), DeviceStatus::Refused);
  EXPECT_THAT(device->problem(), HasSubstr("used by another program"));
}

TEST_F(UltraleapArray, CountsMissedAndLateCallbacks) {
  const auto device = make_ultraleap(setup_of(3));
  Listener listener(4'000);
  Numbered source(3);
  ASSERT_EQ(device->start(source), DeviceStatus::Running);
  stand_in::step(10);
  stand_in::miss(3);
  stand_in::step(10);
  EXPECT_EQ(device->stats().missed_blocks, 3);
  EXPECT_EQ(device->stats().late_blocks, 0);
  stand_in::make_late(true);
  stand_in::step(4);
  stand_in::make_late(false);
  EXPECT_EQ(device->stats().late_blocks, 4);
  EXPECT_EQ(device->stats().blocks, 24);
  // no sample is skipped, and the times include the gap
  const auto heard = listener.heard();
  EXPECT_EQ(heard[160].point[0].p_D, Numbered::sample(160, 0).p_D);
  EXPECT_NEAR(heard[160].time - heard[159].time, 3e-3 + 1.0 / 16e3, 1e-6);
  EXPECT_NEAR(device->play_time(160) - device->play_time(159), heard[160].time - heard[159].time,
              2e-3);
  device->stop();
  EXPECT_EQ(device->stats().missed_blocks, 3) << "kept after the end";
}

TEST_F(UltraleapArray, StopsSafelyDuringCallbacks) {
  auto device = make_ultraleap(setup_of(2));
  auto source = std::make_unique<Numbered>(2);
  ASSERT_EQ(device->start(*source), DeviceStatus::Running);
  stand_in::step(20);
  device->stop();
  source.reset();
  device.reset();  // calls back once more
  EXPECT_EQ(stand_in::callbacks(), 21);

  // likewise with a source that detects calls, at full intensity
  Listener listener(4'000);
  device = make_ultraleap(setup_of(2));
  Numbered alive(2);
  ASSERT_EQ(device->start(alive), DeviceStatus::Running);
  stand_in::step(20);
  device->stop();
  const std::int64_t taken = alive.taken();
  device.reset();
  EXPECT_EQ(alive.taken(), taken);
  EXPECT_EQ(listener.heard().size(), 21U * 20U);
  EXPECT_EQ(listener.heard().back().point[0].intensity, 0.0F);
}

TEST_F(UltraleapArray, FallsSilentIfTheRateChangesDuringPlayback) {
  const auto device = make_ultraleap(setup_of(3));
  Listener listener(8'000);
  Numbered source(3);
  ASSERT_EQ(device->start(source), DeviceStatus::Running);
  stand_in::step(20);
  stand_in::change_rate(20e3F);
  stand_in::step(20);
  EXPECT_EQ(device->status(), DeviceStatus::Vanished);
  EXPECT_THAT(device->problem(), HasSubstr("changed its rate from 16000 to 20000 Hz"));
  EXPECT_EQ(listener.heard().back().point[0].intensity, 0.0F);
  ASSERT_EQ(device->start(source), DeviceStatus::Running) << "with its old rate";
  stand_in::step(5);
  EXPECT_EQ(device->status(), DeviceStatus::Running);
}

TEST_F(UltraleapArray, KeepsItsRateForFewerPointsAndRejectsMore) {
  const auto device = make_ultraleap(setup_of(3));
  Numbered two(2), four(4), seven(7);
  ASSERT_EQ(device->start(two), DeviceStatus::Running);
  EXPECT_EQ(stand_in::control_points(), 2U);
  stand_in::step(10);
  EXPECT_EQ(device->status(), DeviceStatus::Running);
  EXPECT_EQ(device->start(four), DeviceStatus::Refused);
  EXPECT_THAT(device->problem(),
              AllOf(HasSubstr("plays 4 focal points at 13333 Hz"), HasSubstr("made for 16000 Hz")));
  EXPECT_EQ(device->start(seven), DeviceStatus::Refused);
  EXPECT_THAT(device->problem(), HasSubstr("does not take 7 focal points"));
  EXPECT_EQ(device->start(two), DeviceStatus::Running) << device->problem();
  EXPECT_THAT(refusal(setup_of(2)), HasSubstr("cannot be claimed (the device is claimed)"));
}

TEST_F(UltraleapArray, RepeatsASegment) {
  const auto device = make_ultraleap(setup_of(2));
  std::vector<FocusSample> loop(2 * 100);
  for (std::size_t i = 0; i < loop.size(); ++i)
    loop[i] = Numbered::sample(static_cast<std::int64_t>(i / 2), static_cast<int>(i % 2));
  Listener listener(8'000);
  ASSERT_EQ(device->load_segment(loop, 2), DeviceStatus::Running) << device->problem();
  stand_in::step(20);                               // 400 samples
  for (FocusSample& s : loop) s.p_D.z() = 0.1998F;  // closer than a jump
  ASSERT_EQ(device->load_segment(loop, 2), DeviceStatus::Running);
  stand_in::step(20);
  const auto heard = listener.heard();
  ASSERT_EQ(heard.size(), 800U);
  bool changed = false;
  for (std::size_t i = 20; i < heard.size(); ++i) {
    const FocusSample given = Numbered::sample(static_cast<std::int64_t>(i % 100), 1);
    ASSERT_EQ(heard[i].point[1].p_D.x(), given.p_D.x()) << i;
    ASSERT_NEAR(heard[i].point[1].intensity, given.intensity, 1e-6F);
    const bool is_new = heard[i].point[1].p_D.z() < 0.1999F;
    if (is_new && !changed) {
      EXPECT_EQ(i % 100, 0U) << "laps stay complete";
    }
    changed = changed || is_new;
  }
  EXPECT_TRUE(changed);
  EXPECT_EQ(device->load_segment(loop, 1), DeviceStatus::Refused);
  EXPECT_THAT(device->problem(), HasSubstr("stop it first"));
  EXPECT_EQ(device->status(), DeviceStatus::Running);
  device->stop();
  loop[0].intensity = 2.0F;
  EXPECT_EQ(device->load_segment(loop, 2), DeviceStatus::Refused);
  EXPECT_THAT(device->problem(), HasSubstr("Sample 0"));
  Numbered source(2);
  ASSERT_EQ(device->start(source), DeviceStatus::Running);
  loop[0].intensity = 0.5F;
  EXPECT_EQ(device->load_segment(loop, 2), DeviceStatus::Refused);
}

}  // namespace
}  // namespace prostm
