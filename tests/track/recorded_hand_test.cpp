#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "hands.hpp"
#include "prostm/core/random.hpp"
#include "prostm/io/hand/hand_file.hpp"
#include "prostm/track/hand_source.hpp"
#include "support/heap_guard.hpp"
#include "support/shared.hpp"

namespace prostm {
namespace {

constexpr double kStep = 0.02;

using test::hand_at;

/// Returns a hand in linear motion, sampled at irregular times.
HandRecording linear_recording(const Vec3& start, const Vec3& velocity, int frames,
                               std::uint64_t seed) {
  Random random(seed);
  HandRecording recording;
  double t = 0.0;
  for (int i = 0; i < frames; ++i) {
    HandFrame frame;
    frame.time = t;
    frame.hands.push_back(hand_at(7, start + t * velocity));
    recording.frames.push_back(frame);
    t += random.uniform(0.0004, 0.027);
  }
  return recording;
}

TEST(RecordedHand, LinearMotionAtIrregularTimesIsExact) {
  const Vec3 start(0.1, 0.2, -0.05), velocity(0.3, -0.2, 0.5);
  const auto source =
      make_recorded_hand(linear_recording(start, velocity, 200, 1), {}, false, kStep);
  HandFrame frame;
  Random random(2);
  double t = 0.0;
  for (int n = 0; t < source->recording_length(); ++n, t += random.uniform(0.0, 0.01)) {
    source->sample(t, frame);
    ASSERT_EQ(frame.hands.size(), 1u);
    EXPECT_EQ(frame.time, t);
    EXPECT_LT((frame.hands[0].position[kPalm] - start - t * velocity).norm(), 1e-14);
    EXPECT_LT((frame.hands[0].velocity[kIndexTip] - velocity).norm(), 1e-9) << t;
  }
}

TEST(RecordedHand, OrientationsRotateEvenly) {
  HandRecording recording;
  for (const double t : {0.0, 0.03}) {
    HandFrame frame;
    frame.time = t;
    frame.hands.push_back(hand_at(1, Vec3::Zero()));
    frame.hands[0].orientation.fill(Quat(Eigen::AngleAxisd(t / 0.03, Vec3::UnitY())));
    recording.frames.push_back(frame);
  }
  const auto source = make_recorded_hand(recording, {}, false, kStep);
  HandFrame frame;
  source->sample(0.009, frame);
  EXPECT_NEAR(frame.hands[0].orientation[kWrist].angularDistance(
                  Quat(Eigen::AngleAxisd(0.3, Vec3::UnitY()))),
              0.0, 1e-7);
}

TEST(RecordedHand, TheVelocityOfASineIsThatOfTheSmoothedSine) {
  // both smoothings of (H1), the means and the difference, multiply a sine's derivative by a sinc
  // each
  constexpr double kOmega = 20.0, kAmplitude = 0.03;
  HandRecording recording;
  for (int i = 0; i < 1000; ++i) {
    HandFrame frame;
    frame.time = 0.001 * i;
    frame.hands.push_back(hand_at(1, Vec3(kAmplitude * std::sin(kOmega * frame.time), 0, 0)));
    recording.frames.push_back(frame);
  }
  const TrackSettings settings;
  const auto source = make_recorded_hand(recording, settings, false, kStep);
  const double half = 0.5 * kOmega * settings.smoothing_time, sinc = std::sin(half) / half;
  HandFrame frame;
  for (double t = 0.1; t < 0.9; t += 0.0137) {
    source->sample(t, frame);
    EXPECT_NEAR(frame.hands[0].velocity[kPalm].x(),
                kAmplitude * kOmega * std::cos(kOmega * t) * sinc * sinc, 2e-4);
  }
}

TEST(RecordedHand, SpeedIsClampedAndKeepsItsDirection) {
  TrackSettings settings;
  settings.max_speed = 2.0;
  HandRecording recording = linear_recording(Vec3::Zero(), Vec3(0.1, 0, 0), 100, 3);
  // an outlier: one frame half a metre away
  for (Vec3& p : recording.frames[50].hands[0].position) p += Vec3(0.3, 0.4, 0.0);
  const double glitch = recording.frames[50].time;
  const auto source = make_recorded_hand(recording, settings, false, kStep);
  HandFrame frame;
  double fastest = 0.0;
  for (double t = 0.0; t < source->recording_length(); t += 0.002) {
    source->sample(t, frame);
    const Vec3 v = frame.hands[0].velocity[kPalm];
    fastest = std::max(fastest, v.norm());
    if (v.norm() > 1.99) {
      EXPECT_GT(std::abs(v.normalized().dot(Vec3(0.6, 0.8, 0.0))), 0.99);
      EXPECT_LT(std::abs(t - glitch), 0.06);
    }
  }
  EXPECT_NEAR(fastest, 2.0, 1e-12);
}

TEST(RecordedHand, HandsComeAndGoAndShortGapsAreBridged) {
  HandRecording recording;
  for (int i = 0; i <= 100; ++i) {
    HandFrame frame;
    frame.time = 0.01 * i;
    const bool short_gap = i > 20 && i<25, long_gap = i> 40 && i < 60;
    if (!short_gap && !long_gap) frame.hands.push_back(hand_at(1, Vec3(frame.time, 0, 0)));
    if (i >= 30) frame.hands.push_back(hand_at(2, Vec3(0, 0, 1)));
    recording.frames.push_back(frame);
  }
  const auto source = make_recorded_hand(recording, {}, false, kStep);
  HandFrame frame;
  for (int i = 0; i < 1000; ++i) {
    const double t = 0.001 * i + 0.0003;
    source->sample(t, frame);
    bool first = false, second = false;
    for (const Hand& hand : frame.hands) {
      (hand.id == 1 ? first : second) = true;
      if (hand.id == 1) {
        EXPECT_NEAR(hand.position[kPalm].x(), t, 1e-12);
        EXPECT_LT((hand.velocity[kPalm] - Vec3(1, 0, 0)).norm(), 1e-9);
      }
    }
    EXPECT_EQ(first, t <= 0.40 || t >= 0.60) << t;
    EXPECT_EQ(second, t >= 0.30) << t;
  }
}

TEST(RecordedHand, ALoopIsAHandThatLeavesAndComesBack) {
  const HandRecording recording = linear_recording(Vec3::Zero(), Vec3(1.0, 0, 0), 40, 5);
  const double length = recording.frames.back().time;
  const auto source = make_recorded_hand(recording, {}, true, kStep);
  HandFrame frame;
  int without = 0, seams = 0;
  double last_x = 0.0;
  for (int i = 0; i < 1000; ++i) {
    source->sample(kStep * i, frame);
    if (frame.hands.empty()) {
      ++without;
      continue;
    }
    const double x = frame.hands[0].position[kPalm].x();
    if (x < last_x) {
      ++seams;
      EXPECT_GE(without, 1) << "the hand jumped back instead of leaving";
    }
    EXPECT_LT((frame.hands[0].velocity[kPalm] - Vec3(1.0, 0, 0)).norm(), 1e-9)
        << "a velocity was taken across the seam";
    last_x = x;
    without = 0;
  }
  EXPECT_GE(seams, static_cast<int>(20.0 / (length + 2 * kStep)) - 1);
}

TEST(RecordedHand, EndsWithoutALoopAndIsEmptyBeforeTheStart) {
  const HandRecording recording = linear_recording(Vec3::Zero(), Vec3(1.0, 0, 0), 10, 6);
  const auto source = make_recorded_hand(recording, {}, false, kStep);
  EXPECT_EQ(source->recording_length(), recording.frames.back().time);
  HandFrame frame;
  source->sample(-0.01, frame);
  EXPECT_TRUE(frame.hands.empty());
  source->sample(source->recording_length(), frame);
  EXPECT_EQ(frame.hands.size(), 1u);
  source->sample(source->recording_length() + 1e-6, frame);
  EXPECT_TRUE(frame.hands.empty());
}

TEST(RecordedHand, SeekingContinuesFromThereAsAnotherHand) {
  const HandRecording recording = linear_recording(Vec3::Zero(), Vec3(1.0, 0, 0), 100, 6);
  const auto source = make_recorded_hand(recording, {}, true, kStep);
  EXPECT_EQ(source->recording_length(), recording.frames.back().time);
  HandFrame frame;
  source->sample(0.10, frame);
  EXPECT_EQ(source->recording_time(), 0.10);
  const std::int64_t id = frame.hands[0].id;
  for (const double to : {0.5, 0.2}) {
    source->seek(to);
    source->sample(3.0, frame);
    EXPECT_NEAR(source->recording_time(), to, 1e-12);
    ASSERT_EQ(frame.hands.size(), 1u);
    EXPECT_NEAR(frame.hands[0].position[kPalm].x(), to, 1e-12);
    EXPECT_NE(frame.hands[0].id, id);
    source->sample(3.1, frame);
    EXPECT_NEAR(frame.hands[0].position[kPalm].x(), to + 0.1, 1e-12);
  }
  source->seek(1e9);
  source->sample(3.2, frame);
  EXPECT_NEAR(source->recording_time(), source->recording_length(), 1e-12);
}

TEST(RecordedHand, ASingleFrameIsAtRest) {
  const auto source =
      make_recorded_hand(linear_recording(Vec3(1, 2, 3), Vec3(1, 0, 0), 1, 1), {}, false, kStep);
  HandFrame frame;
  source->sample(0.0, frame);
  ASSERT_EQ(frame.hands.size(), 1u);
  EXPECT_EQ(frame.hands[0].velocity[kPalm], Vec3::Zero());
}

TEST(RecordedHand, SamplingAllocatesNothing) {
  const auto source =
      make_recorded_hand(linear_recording(Vec3::Zero(), Vec3(1, 0, 0), 100, 8), {}, true, kStep);
  HandFrame frame;
  test::HeapGuard guard;
  for (int i = 0; i < 200; ++i) source->sample(kStep * i, frame);
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(RecordedHand, RejectsRecordingsThatItCannotPlay) {
  EXPECT_THROW(make_recorded_hand({}, {}, false, kStep), std::invalid_argument);
  EXPECT_THROW(
      make_recorded_hand(linear_recording(Vec3::Zero(), Vec3::Zero(), 3, 1), {}, true, 0.0),
      std::invalid_argument);
  HandRecording backwards = linear_recording(Vec3::Zero(), Vec3::Zero(), 3, 1);
  backwards.frames[2].time = backwards.frames[1].time;
  EXPECT_THROW(make_recorded_hand(backwards, {}, false, kStep), std::invalid_argument);
  HandRecording twice = linear_recording(Vec3::Zero(), Vec3::Zero(), 3, 1);
  twice.frames[1].hands.push_back(twice.frames[1].hands[0]);
  EXPECT_THROW(make_recorded_hand(twice, {}, false, kStep), std::invalid_argument);
  TrackSettings settings;
  settings.smoothing_time = 0.0;
  try {
    make_recorded_hand(linear_recording(Vec3::Zero(), Vec3::Zero(), 3, 1), settings, false, kStep);
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_STREQ(e.what(), "smoothing_time = 0 s must be between 0.001 and 0.5 s");
  }
}

TEST(RecordedHand, HandsBelowTheMinimumConfidenceAreRejected) {
  HandRecording recording = linear_recording(Vec3::Zero(), Vec3(1, 0, 0), 20, 1);
  const double length = recording.frames.back().time, middle = recording.frames[9].time;
  for (std::size_t i = 10; i < 20; ++i) recording.frames[i].hands[0].confidence = 0.05;
  for (const auto make : {make_recorded_hand, make_replayed_hand}) {
    const auto source = make(recording, {}, false, kStep);
    HandFrame frame;
    source->sample(0.5 * middle, frame);
    EXPECT_EQ(frame.hands.size(), 1u);
    source->sample(length, frame);
    EXPECT_EQ(frame.hands.size(), 0u);
    TrackSettings all;
    all.least_confidence = 0.05;
    const auto unbounded = make(recording, all, false, kStep);
    unbounded->sample(length, frame);
    EXPECT_EQ(frame.hands.size(), 1u);
  }
  // nothing would be played: the source throws with a message
  for (HandFrame& frame : recording.frames) frame.hands[0].confidence = 0.0;
  for (const auto make : {make_recorded_hand, make_replayed_hand}) {
    try {
      make(recording, {}, false, kStep);
      FAIL();
    } catch (const std::invalid_argument& e) {
      EXPECT_STREQ(e.what(),
                   "all 20 hands of the recording have a confidence of at most 0, below "
                   "least_confidence = 0.1 of [track]; lower it to play them");
    }
  }
}

// a recording may be at rest, unlike a live tracker
TEST(RecordedHand, AHandAtRestIsPlayedThroughout) {
  for (const auto make : {make_recorded_hand, make_replayed_hand}) {
    const auto source =
        make(linear_recording(Vec3(0, 0.2, 0), Vec3::Zero(), 300, 1), {}, false, kStep);
    HandFrame frame;
    for (double time = 0.0; time <= source->recording_length(); time += kStep) {
      source->sample(time, frame);
      ASSERT_EQ(frame.hands.size(), 1u) << time;
    }
  }
}

TEST(RecordedHand, RealRecordingsPlayWithFiniteClampedVelocities) {
  for (const char* name :
       {"flapping", "rollAndPitchWithEntry", "HandSplay-110fps", "pinch-57fps"}) {
    const std::string file = std::string("data/hands/") + name + ".hands.jsonl";
    PROSTM_NEEDS_SHARED(file);
    const TrackSettings settings;
    const auto source =
        make_recorded_hand(read_hand_recording(test::shared_file(file)), settings, false, kStep);
    HandFrame frame;
    for (double t = 0.0; t < source->recording_length(); t += 0.005) {
      source->sample(t, frame);
      for (const Hand& hand : frame.hands) {
        for (const Vec3& v : hand.velocity) {
          ASSERT_TRUE(v.allFinite());
          EXPECT_LE(v.norm(), settings.max_speed * (1 + 1e-12));
        }
        for (const Quat& q : hand.orientation) EXPECT_NEAR(q.norm(), 1.0, 1e-12);
      }
    }
  }
}

TEST(RecordedHand, HalfOfTheFramesGiveNearlyTheSameHands) {
  PROSTM_NEEDS_SHARED("data/hands/rollAndPitchWithEntry.hands.jsonl");
  const HandRecording full =
      read_hand_recording(test::shared_file("data/hands/rollAndPitchWithEntry.hands.jsonl"));
  HandRecording half;
  for (std::size_t i = 0; i < full.frames.size(); i += 2) half.frames.push_back(full.frames[i]);
  const auto a = make_recorded_hand(full, {}, false, kStep),
             b = make_recorded_hand(half, {}, false, kStep);
  HandFrame at_full, at_half;
  double position = 0.0, velocity = 0.0, speed = 0.0;
  int count = 0;
  for (double t = 0.1; t < b->recording_length() - 0.1; t += kStep, ++count) {
    a->sample(t, at_full);
    b->sample(t, at_half);
    ASSERT_EQ(at_full.hands.size(), at_half.hands.size());
    if (at_full.hands.empty()) continue;
    position += (at_full.hands[0].position[kPalm] - at_half.hands[0].position[kPalm]).norm();
    velocity += (at_full.hands[0].velocity[kPalm] - at_half.hands[0].velocity[kPalm]).norm();
    speed += at_full.hands[0].velocity[kPalm].norm();
  }
  EXPECT_LT(position / count, 2e-4);
  EXPECT_LT(velocity, 0.1 * speed);
}

/// Returns two right hands and a left one that appears later, in linear motion.
HandRecording three_hands(int frames) {
  HandRecording recording;
  for (int i = 0; i < frames; ++i) {
    HandFrame frame;
    frame.time = 0.01 * i;
    frame.hands.push_back(hand_at(1, Vec3(frame.time, 0.2, 0)));
    if (i < 20) frame.hands.push_back(hand_at(2, Vec3(0.1, 0.2, -frame.time)));
    if (i >= 30) frame.hands.push_back(hand_at(3, Vec3(0.1, 0.2, frame.time), Side::Left));
    recording.frames.push_back(frame);
  }
  return recording;
}

TEST(HandSources, AHandRenamedInEveryFrameContinues) {
  const HandRecording named = three_hands(50);
  HandRecording renamed = named;
  std::int64_t id = 100;
  for (HandFrame& frame : renamed.frames) {
    if (frame.hands.size() == 2 && id % 3 == 0) std::swap(frame.hands[0], frame.hands[1]);
    for (Hand& hand : frame.hands) hand.id = ++id;
  }
  for (const auto make : {make_recorded_hand, make_replayed_hand}) {
    const auto a = make(named, {}, false, kStep), b = make(renamed, {}, false, kStep);
    HandFrame expected, actual;
    std::int64_t first_id = 0;
    for (double t = 0.0003; t < 0.49; t += 0.003) {
      a->sample(t, expected);
      b->sample(t, actual);
      ASSERT_EQ(actual.hands.size(), expected.hands.size()) << t;
      for (const Hand& hand : expected.hands) {
        const auto same =
            std::find_if(actual.hands.begin(), actual.hands.end(), [&](const Hand& other) {
              return other.side == hand.side && other.position[kPalm] == hand.position[kPalm];
            });
        ASSERT_NE(same, actual.hands.end()) << t;
        EXPECT_EQ(same->velocity[kPalm], hand.velocity[kPalm]) << t;
        if (hand.id % 1'000'000 != 1) continue;
        if (first_id == 0) first_id = same->id;
        EXPECT_EQ(same->id, first_id) << t;
      }
    }
  }
}

TEST(HandSources, ANewIdFarAwayIsAnotherHand) {
  HandRecording recording;
  for (int i = 0; i < 20; ++i) {
    HandFrame frame;
    frame.time = 0.01 * i;
    // 40 mm in 10 ms: faster than any hand
    frame.hands.push_back(hand_at(i < 10 ? 7 : 8, Vec3(i < 10 ? 0.0 : 0.04, 0.2, 0)));
    recording.frames.push_back(frame);
  }
  const auto source = make_recorded_hand(recording, {}, false, kStep);
  HandFrame frame;
  source->sample(0.085, frame);
  EXPECT_EQ(frame.hands.at(0).id, 7);
  source->sample(0.095, frame);
  EXPECT_TRUE(frame.hands.empty());
  source->sample(0.105, frame);
  EXPECT_EQ(frame.hands.at(0).id, 8);
  EXPECT_LT(frame.hands[0].velocity[kPalm].norm(), 1e-9);
}

TEST(HandSources, RejectARecordingThatIsTooSlow) {
  HandRecording recording;
  for (int i = 0; i < 20; ++i) {
    HandFrame frame;
    frame.time = 0.1 * i;
    frame.hands.push_back(hand_at(7, Vec3(0, 0.2, 0)));
    recording.frames.push_back(frame);
  }
  for (const auto make : {make_recorded_hand, make_replayed_hand}) {
    try {
      make(recording, {}, false, kStep);
      FAIL() << "10 frames a second were accepted";
    } catch (const std::invalid_argument& e) {
      EXPECT_NE(std::string(e.what()).find("max_gap = 0.06 s"), std::string::npos) << e.what();
    }
  }
  TrackSettings patient;
  patient.max_gap = 0.2;
  EXPECT_NO_THROW(make_recorded_hand(recording, patient, false, kStep));
}

}  // namespace
}  // namespace prostm
