#include "prostm/track/detail/causal_track.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "hands.hpp"
#include "prostm/core/random.hpp"
#include "support/heap_guard.hpp"
#include "support/load.hpp"

namespace prostm {
namespace {

using test::hand_at;

HandFrame frame_at(double time, const Vec3& p, std::int64_t id = 1) {
  HandFrame frame;
  frame.time = time;
  frame.hands.push_back(hand_at(id, p));
  return frame;
}

/// Returns a recording of linear motion, sampled at irregular times.
HandRecording linear_recording(const Vec3& velocity, int frames) {
  Random random(4);
  HandRecording recording;
  double t = 0.0;
  for (int i = 0; i < frames; ++i, t += random.uniform(0.0011, 0.027)) {
    recording.frames.push_back(frame_at(t, t * velocity));
  }
  return recording;
}

TEST(CausalTrack, ConstantVelocityAtIrregularTimesIsPredictedExactly) {
  TrackSettings settings;
  settings.prediction = 0.02;
  settings.prediction_limit = 0.1;
  CausalTrack track(settings);
  const Vec3 start(0.1, 0.2, -0.05), velocity(0.3, -0.2, 0.5);
  Random random(2);
  HandFrame out;
  double t = 0.0;
  for (int i = 0; i < 500; ++i) {
    ASSERT_TRUE(track.add(frame_at(t, start + t * velocity)));
    const double age = random.uniform(0.0, 0.02);
    track.sample(t + age, out);
    ASSERT_EQ(out.hands.size(), 1u);
    EXPECT_EQ(out.time, t + age);
    EXPECT_NEAR(out.age, age, 1e-12);
    if (i > 0) {
      EXPECT_LT((out.hands[0].velocity[kIndexTip] - velocity).norm(), 1e-9);
      EXPECT_LT((out.hands[0].position[kPalm] - start - (t + age + 0.02) * velocity).norm(), 1e-9);
    }
    t += random.uniform(0.0011, 0.027);
  }
}

TEST(CausalTrack, WithoutPredictionTheNewestFrameIsHeld) {
  TrackSettings settings;
  settings.prediction = 0.0;
  CausalTrack track(settings);
  HandFrame frame = frame_at(0.0, Vec3::Zero());
  track.add(frame);
  frame = frame_at(0.01, Vec3(0.02, 0, 0));
  frame.hands[0].orientation.fill(Quat(Eigen::AngleAxisd(0.4, Vec3::UnitY())));
  frame.hands[0].confidence = 0.5;
  track.add(frame);
  HandFrame out;
  track.sample(0.04, out);
  EXPECT_EQ(out.hands[0].position[kPalm], Vec3(0.02, 0, 0));
  EXPECT_NEAR(out.hands[0].velocity[kPalm].x(), 2.0, 1e-12);
  EXPECT_EQ(out.hands[0].orientation[kWrist].coeffs(), frame.hands[0].orientation[kWrist].coeffs());
  EXPECT_EQ(out.hands[0].confidence, 0.5);
}

TEST(CausalTrack, VelocityUnderAccelerationIsThatOfTheMiddleOfTheWindow) {
  // the least-squares slope of a t²/2 over evenly spaced frames is a times their mean time
  TrackSettings settings;
  settings.smoothing_time = 0.0401;
  CausalTrack track(settings);
  constexpr double kAcceleration = 5.0;
  HandFrame out;
  for (int i = 0; i <= 30; ++i) {
    const double t = 0.01 * i;
    track.add(frame_at(t, Vec3(0, 0.5 * kAcceleration * t * t, 0)));
    track.sample(t, out);
    if (i >= 4) {
      EXPECT_NEAR(out.hands[0].velocity[kPalm].y(), kAcceleration * (t - 0.02), 1e-9);
    }
  }
}

TEST(CausalTrack, PredictionAndSpeedAreBounded) {
  TrackSettings settings;
  settings.prediction = 0.05;
  settings.prediction_limit = 0.012;
  settings.max_speed = 2.0;
  CausalTrack track(settings);
  const Vec3 direction = Vec3(1, 2, -2) / 3.0;
  for (int i = 0; i < 10; ++i) track.add(frame_at(0.01 * i, 0.05 * i * direction));  // 5 m/s
  HandFrame out;
  track.sample(0.1, out);
  EXPECT_LT((out.hands[0].velocity[kPalm] - 2.0 * direction).norm(), 1e-9);
  EXPECT_LT((out.hands[0].position[kPalm] - (0.45 + 0.012) * direction).norm(), 1e-9);
}

TEST(CausalTrack, HandsComeAndGoAndShortGapsAreBridged) {
  const TrackSettings settings;
  CausalTrack track(settings);
  HandFrame out, nothing;
  track.sample(0.0, out);
  EXPECT_TRUE(out.hands.empty());
  EXPECT_EQ(out.age, 0.0);
  for (int i = 0; i < 5; ++i) track.add(frame_at(0.01 * i, Vec3(0.01 * i, 0, 0)));
  // frames without the hand: it remains for max_gap
  for (int i = 5; i < 20; ++i) {
    nothing.time = 0.01 * i;
    EXPECT_TRUE(track.add(nothing));
    track.sample(nothing.time, out);
    EXPECT_EQ(out.hands.size(), 0.01 * i - 0.04 <= settings.max_gap ? 1u : 0u) << i;
    EXPECT_EQ(out.age, 0.0);
  }
  // and returns without its old velocity
  track.add(frame_at(0.2, Vec3(-1, 0, 0)));
  track.sample(0.2, out);
  ASSERT_EQ(out.hands.size(), 1u);
  EXPECT_EQ(out.hands[0].velocity[kPalm], Vec3::Zero());
  // without any frames
  track.sample(0.2 + 1.01 * settings.max_gap, out);
  EXPECT_TRUE(out.hands.empty());
}

TEST(CausalTrack, ANewIdOfTheSameSideReplacesTheLostOne) {
  CausalTrack track{TrackSettings()};
  HandFrame frame, out;
  for (int i = 0; i < 4; ++i) {
    frame = frame_at(0.01 * i, Vec3::Zero(), 5);
    frame.hands.push_back(hand_at(6, Vec3(0.2, 0, 0), Side::Left));
    track.add(frame);
  }
  // the right hand is lost and detected again as number 9
  frame = frame_at(0.04, Vec3(0.01, 0, 0), 9);
  frame.hands.push_back(hand_at(6, Vec3(0.2, 0, 0), Side::Left));
  track.add(frame);
  track.sample(0.04, out);
  ASSERT_EQ(out.hands.size(), 2u);
  EXPECT_EQ(out.hands[0].id + out.hands[1].id, 15);
  // a new right hand does not shorten the left one's gap
  track.add(frame_at(0.05, Vec3(0.01, 0, 0), 10));
  track.sample(0.05, out);
  ASSERT_EQ(out.hands.size(), 2u);
  EXPECT_EQ(out.hands[0].id + out.hands[1].id, 16);
}

TEST(CausalTrack, RejectsTimeThatDoesNotIncreaseAndCanBeReset) {
  CausalTrack track{TrackSettings()};
  EXPECT_TRUE(track.add(frame_at(1.0, Vec3::Zero())));
  EXPECT_FALSE(track.add(frame_at(1.0, Vec3(1, 0, 0))));
  EXPECT_FALSE(track.add(frame_at(0.5, Vec3(1, 0, 0))));
  HandFrame out;
  track.sample(1.0, out);
  EXPECT_EQ(out.hands[0].position[kPalm], Vec3::Zero());
  track.clear();
  track.sample(1.0, out);
  EXPECT_TRUE(out.hands.empty());
  EXPECT_TRUE(track.add(frame_at(0.5, Vec3::Zero())));
}

TEST(CausalTrack, AnySequenceGivesFiniteBoundedHands) {
  // frames from a nanosecond to a tenth of a second apart, hands with any two ids anywhere
  const TrackSettings settings;
  CausalTrack track(settings);
  Random random(8);
  HandFrame out;
  const auto place = [&] {
    return Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  };
  for (std::uint64_t sequence = 0; sequence < test::reduced(100'000); ++sequence) {
    track.clear();
    double t = random.uniform(0.0, 1e4);
    for (int i = 0; i < 5; ++i, t += std::pow(10.0, random.uniform(-9.0, -1.0))) {
      HandFrame frame;
      frame.time = t;
      if (random.uniform() < 0.8) frame.hands.push_back(hand_at(random.uniform() < 0.7, place()));
      if (random.uniform() < 0.3) frame.hands.push_back(hand_at(7, place(), Side::Left));
      track.add(frame);
      track.sample(t + random.uniform(0.0, 0.1), out);
      ASSERT_LE(out.hands.size(), 2u);
      for (const Hand& hand : out.hands) {
        ASSERT_TRUE(hand.position[kPalm].allFinite() && hand.velocity[kPalm].allFinite());
        ASSERT_LE(hand.velocity[kPalm].norm(), settings.max_speed * (1 + 1e-9));
        ASSERT_LE(hand.position[kPalm].cwiseAbs().maxCoeff(), 1.0 + settings.prediction_limit);
      }
    }
  }
}

TEST(CausalTrack, DoesNotAllocate) {
  CausalTrack track{TrackSettings()};
  HandFrame out;
  test::HeapGuard guard;
  for (int i = 0; i < 300; ++i) {
    track.add(frame_at(0.009 * i, Vec3(0.001 * i, 0, 0)));
    track.sample(0.009 * i + 0.004, out);
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(CausalTrack, RejectsSettingsOutOfBounds) {
  for (const double bad : {-0.001, 0.3}) {
    TrackSettings settings;
    settings.prediction = bad;
    EXPECT_THROW(CausalTrack{settings}, std::invalid_argument) << bad;
    settings = {};
    settings.prediction_limit = bad;
    EXPECT_THROW(CausalTrack{settings}, std::invalid_argument) << bad;
  }
}

TEST(ReplayedHand, UsesOnlyFramesThatHaveArrived) {
  TrackSettings settings;
  settings.prediction = 0.0;
  const HandRecording recording = linear_recording(Vec3(1.0, 0, 0), 60);
  HandRecording late = recording;  // the same up to frame 30
  for (std::size_t i = 30; i < late.frames.size(); ++i) late.frames[i].hands.clear();
  const auto source = make_replayed_hand(recording, settings, false, 0.02);
  const auto other = make_replayed_hand(late, settings, false, 0.02);
  HandFrame frame, same;
  std::size_t i = 0;
  for (double t = 0.0; t < recording.frames[30].time; t += 0.003) {
    while (i + 1 < recording.frames.size() && recording.frames[i + 1].time <= t) ++i;
    source->sample(t, frame);
    other->sample(t, same);
    ASSERT_EQ(frame.hands.size(), 1u);
    EXPECT_EQ(frame.hands[0].position[kPalm], recording.frames[i].hands[0].position[kPalm]);
    EXPECT_NEAR(frame.age, t - recording.frames[i].time, 1e-12);
    EXPECT_EQ(frame.hands[0].position[kPalm], same.hands[0].position[kPalm]);
    EXPECT_EQ(frame.hands[0].velocity[kPalm], same.hands[0].velocity[kPalm]);
  }
}

TEST(ReplayedHand, LoopsLikeAHandThatLeavesAndReturnsAsAnother) {
  const TrackSettings settings;
  const auto source =
      make_replayed_hand(linear_recording(Vec3(0.1, 0, 0), 40), settings, true, 0.02);
  const double length = source->recording_length();
  HandFrame frame;
  int seams = 0, without = 0;
  std::int64_t last = -1;
  for (int i = 0; i < 1000; ++i) {
    source->sample(0.02 * i, frame);
    EXPECT_LT(frame.age, 0.03);  // frames without hands arrive at the seam
    if (frame.hands.empty()) {
      ++without;
      continue;
    }
    if (last >= 0 && frame.hands[0].id != last) {
      ++seams;
      EXPECT_GE(without, 1);
    }
    last = frame.hands[0].id;
    without = 0;
  }
  EXPECT_NEAR(seams, 20.0 / (length + settings.max_gap + 0.04), 1.0);
}

TEST(ReplayedHand, SeeksWithThePrecedingFrames) {
  TrackSettings settings;
  settings.prediction = 0.0;
  const auto source =
      make_replayed_hand(linear_recording(Vec3(0.5, 0, 0), 100), settings, true, 0.02);
  HandFrame frame;
  source->sample(0.5, frame);
  EXPECT_EQ(source->recording_time(), 0.5);
  const std::int64_t id = frame.hands[0].id;
  source->seek(0.3);
  source->sample(0.7, frame);
  EXPECT_NEAR(source->recording_time(), 0.3, 1e-12);
  ASSERT_EQ(frame.hands.size(), 1u);
  EXPECT_NE(frame.hands[0].id, id);
  EXPECT_NEAR(frame.hands[0].position[kPalm].x(), 0.5 * 0.3, 0.5 * 0.027);
  EXPECT_NEAR(frame.hands[0].velocity[kPalm].x(), 0.5, 1e-9);
  source->sample(0.8, frame);
  EXPECT_NEAR(source->recording_time(), 0.4, 1e-12);
}

TEST(ReplayedHand, EndsAndAllocatesNothing) {
  const auto source = make_replayed_hand(linear_recording(Vec3(0.1, 0, 0), 40), {}, false, 0.02);
  HandFrame frame;
  test::HeapGuard guard;
  source->sample(-0.01, frame);
  EXPECT_TRUE(frame.hands.empty());
  source->sample(source->recording_length(), frame);
  EXPECT_EQ(frame.hands.size(), 1u);
  source->sample(source->recording_length() + 1e-6, frame);
  EXPECT_TRUE(frame.hands.empty());
  source->seek(0.1);
  source->sample(7.0, frame);
  EXPECT_EQ(frame.hands.size(), 1u);
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_THROW(make_replayed_hand({}, {}, false, 0.02), std::invalid_argument);
}

}  // namespace
}  // namespace prostm
