#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "prostm/track/hand_source.hpp"
#include "support/heap_guard.hpp"

namespace prostm {
namespace {

HandFrame at(HandSource& source, double t) {
  HandFrame frame;
  source.sample(t, frame);
  return frame;
}

double bone(const Hand& hand, int from) {
  return (hand.position[static_cast<std::size_t>(from) + 1] -
          hand.position[static_cast<std::size_t>(from)])
      .norm();
}

TEST(ScriptedHand, HoversOpenAndPalmDownOverTheTracker) {
  ScriptedHandSettings settings;
  settings.still = true;
  settings.height = 0.18;
  const auto source = make_scripted_hand(settings, {});
  const HandFrame frame = at(*source, 1.0);
  ASSERT_EQ(frame.hands.size(), 1u);
  const Hand& hand = frame.hands[0];
  EXPECT_EQ(hand.side, Side::Right);
  EXPECT_LT((hand.position[kPalm] - Vec3(0, 0.18, 0)).norm(), 1e-12);
  // dorsal is up, the middle finger points away from the user, the thumb is on the left
  EXPECT_GT((hand.orientation[kPalm] * Vec3::UnitY()).y(), 0.99);
  EXPECT_LT(hand.position[kMiddleTip].z(), -0.10);
  EXPECT_LT(hand.position[kThumbTip].x(), hand.position[kIndexProximal].x());
  EXPECT_GT(hand.position[kLittleProximal].x(), hand.position[kIndexProximal].x());
  for (const Vec3& p : hand.position) EXPECT_NEAR(p.y(), 0.18, 0.05);
  for (const Vec3& v : hand.velocity) EXPECT_EQ(v, Vec3::Zero());
}

TEST(ScriptedHand, BonesKeepTheirAnatomicalLengthsAndPointAlongTheirFrames) {
  const auto source = make_scripted_hand({}, {});
  for (double t = 0.5; t < 20.0; t += 0.05) {
    const HandFrame frame = at(*source, t);
    if (frame.hands.empty()) continue;
    const Hand& hand = frame.hands[0];
    EXPECT_NEAR(bone(hand, kIndexMetacarpal), 0.06812, 1e-12);
    EXPECT_NEAR(bone(hand, kMiddleProximal), 0.04463, 1e-12);
    EXPECT_NEAR(bone(hand, kLittleIntermediate), 0.01811, 1e-12);
    EXPECT_NEAR(bone(hand, kThumbMetacarpal), 0.04622, 1e-12);
    for (int j = kThumbMetacarpal; j < kLittleTip; ++j) {
      if (j == kThumbTip || j == kIndexTip || j == kMiddleTip || j == kRingTip) continue;
      const auto n = static_cast<std::size_t>(j);
      const Vec3 along = (hand.position[n + 1] - hand.position[n]).normalized();
      EXPECT_GT(along.dot(hand.orientation[n] * Vec3(0, 0, -1)), 1 - 1e-12) << joint_name(j);
    }
  }
}

TEST(ScriptedHand, DoesEverythingInItsScript) {
  const ScriptedHandSettings settings;
  const auto source = make_scripted_hand(settings, {});
  double lowest = 1, highest = 0, left = 0, right = 0, tip_to_wrist = 1;
  int seen = 0, missing = 0;
  for (double t = 0.0; t < settings.period; t += 0.02) {
    const HandFrame frame = at(*source, t);
    if (frame.hands.empty()) {
      ++missing;
      continue;
    }
    ++seen;
    const Hand& hand = frame.hands[0];
    lowest = std::min(lowest, hand.position[kPalm].y());
    highest = std::max(highest, hand.position[kPalm].y());
    const double roll = (hand.orientation[kPalm] * Vec3::UnitX()).y();
    left = std::min(left, roll);
    right = std::max(right, roll);
    tip_to_wrist =
        std::min(tip_to_wrist, (hand.position[kMiddleTip] - hand.position[kWrist]).norm());
  }
  EXPECT_GT(missing, 10);
  EXPECT_GT(seen, 900);
  EXPECT_NEAR(lowest, settings.height - 0.07, 1e-6);
  EXPECT_NEAR(highest, settings.height + 0.04, 1e-3);
  EXPECT_LT(left, -0.3);
  EXPECT_GT(right, 0.3);
  EXPECT_LT(tip_to_wrist, 0.11);  // closed; 0.17 when open
}

TEST(ScriptedHand, VelocitiesAreThoseOfThePositions) {
  const auto source = make_scripted_hand({}, {});
  constexpr double kDelta = 1e-3;
  double fastest = 0.0;
  for (double t = 1.0; t < 19.0; t += 0.037) {
    const HandFrame before = at(*source, t - kDelta), now = at(*source, t),
                    after = at(*source, t + kDelta);
    ASSERT_EQ(before.hands.size() + now.hands.size() + after.hands.size(), 3u) << t;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const Vec3 expected =
          (after.hands[0].position[j] - before.hands[0].position[j]) / (2 * kDelta);
      EXPECT_LT((now.hands[0].velocity[j] - expected).norm(), 2e-4) << t;
      fastest = std::max(fastest, expected.norm());
    }
  }
  EXPECT_GT(fastest, 0.15);
  EXPECT_LT(fastest, 1.0);
}

TEST(ScriptedHand, EveryCycleRepeatsTheMotionWithANewHand) {
  const auto source = make_scripted_hand({}, {});
  const HandFrame first = at(*source, 7.0), second = at(*source, 27.0);
  ASSERT_EQ(first.hands.size() + second.hands.size(), 2u);
  EXPECT_NE(first.hands[0].id, second.hands[0].id);
  EXPECT_LT((first.hands[0].position[kIndexTip] - second.hands[0].position[kIndexTip]).norm(),
            1e-12);
}

TEST(ScriptedHand, JitterIsWhiteNoiseThatReachesTheVelocities) {
  ScriptedHandSettings settings;
  settings.still = true;
  const TrackSettings track;
  const auto quiet = make_scripted_hand(settings, track);
  const HandFrame rest = at(*quiet, 0.0);
  settings.jitter = 3e-4;
  const auto noisy = make_scripted_hand(settings, track),
             again = make_scripted_hand(settings, track);

  double position = 0.0, velocity = 0.0;
  int count = 0;
  for (int i = 0; i < 500; ++i) {
    // at the tracker's own frames positions contain the full noise
    const double t = 1.0 + 11.0 * i / 110.0;
    const HandFrame frame = at(*noisy, t), same = at(*again, t);
    for (std::size_t j = 0; j < kJointCount; ++j, ++count) {
      EXPECT_EQ(frame.hands[0].position[j], same.hands[0].position[j]);
      position += (frame.hands[0].position[j] - rest.hands[0].position[j]).squaredNorm() / 3.0;
      velocity += frame.hands[0].velocity[j].squaredNorm() / 3.0;
    }
  }
  EXPECT_NEAR(std::sqrt(position / count), settings.jitter, 0.03 * settings.jitter);
  // both means of (H1) cover 3.3 frames: sqrt(2 / 3.3) * 0.3 mm / 30 ms
  const double expected =
      std::sqrt(2.0 / (track.smoothing_time * 110.0)) * settings.jitter / track.smoothing_time;
  EXPECT_NEAR(std::sqrt(velocity / count), expected, 0.2 * expected);
}

TEST(ScriptedHand, SeedsDifferAndSamplingAllocatesNothing) {
  ScriptedHandSettings settings;
  settings.jitter = 3e-4;
  const auto one = make_scripted_hand(settings, {});
  settings.seed = 2;
  const auto two = make_scripted_hand(settings, {});
  EXPECT_NE(at(*one, 5.0).hands[0].position[kPalm], at(*two, 5.0).hands[0].position[kPalm]);
  HandFrame frame;
  test::HeapGuard guard;
  for (int i = 0; i < 1100; ++i) one->sample(0.02 * i, frame);
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_EQ(one->recording_length(), 0.0);
}

TEST(ScriptedHand, RejectsSettingsOutOfBounds) {
  ScriptedHandSettings settings;
  settings.height = 1.0;
  try {
    make_scripted_hand(settings, {});
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_STREQ(e.what(), "height = 1 m must be between 0.1 and 0.6 m");
  }
  settings = {};
  settings.jitter = -1e-3;
  EXPECT_THROW(make_scripted_hand(settings, {}), std::invalid_argument);
  settings = {};
  settings.period = 0.0;
  EXPECT_THROW(make_scripted_hand(settings, {}), std::invalid_argument);
}

}  // namespace
}  // namespace prostm
