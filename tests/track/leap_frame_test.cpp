#include "prostm/track/live/leap_frame.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <vector>

#include "leap_json.hpp"
#include "prostm/track/hand_source.hpp"
#include "support/load.hpp"

namespace prostm {
namespace {

/// Returns the scripted hand 5 s after its start, or its mirror image.
HandFrame scripted(bool left) {
  HandFrame frame;
  make_scripted_hand({}, {})->sample(5.0, frame);
  if (!left) return frame;
  Hand& hand = frame.hands.at(0);
  hand.side = Side::Left;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    hand.position[j].x() *= -1.0;
    const Quat& q = hand.orientation[j];
    hand.orientation[j] = Quat(q.w(), q.x(), -q.y(), -q.z());
  }
  return frame;
}

TEST(LeapFrame, BasesOfLeftHandsMayHaveEitherHandedness) {
  for (const bool left : {false, true}) {
    const HandFrame sent = scripted(left);
    for (const bool mirrored : {false, true}) {
      HandFrame frame;
      HandFaults faults;
      ASSERT_EQ(leap_message(test::leap_json(sent, mirrored).dump(), frame, faults),
                LeapMessage::Frame);
      ASSERT_FALSE(faults.any()) << faults.first;
      const Hand &a = frame.hands.at(0), &b = sent.hands.at(0);
      EXPECT_EQ(a.side, b.side);
      EXPECT_EQ(a.inferred, 0u);
      for (std::size_t j = kWrist; j < kJointCount; ++j) {
        EXPECT_LT((a.position[j] - b.position[j]).norm(), 1e-9);
        EXPECT_EQ(a.velocity[j], Vec3::Zero());
        // the tips rotate with their last bones, as in the skeleton
        EXPECT_LT(a.orientation[j].angularDistance(b.orientation[j]), 1e-6) << j;
      }
    }
  }
}

TEST(LeapFrame, GreetingsAndEventsAreNotFrames) {
  HandFrame frame;
  HandFaults faults;
  for (const char* text :
       {R"({"serviceVersion":"2.3.1+33747","version":6})", R"({"version":6})",
        R"({"event":{"type":"deviceEvent","state":{"attached":true,"id":"x"}}})"}) {
    EXPECT_EQ(leap_message(text, frame, faults), LeapMessage::Other) << text;
  }
  EXPECT_EQ(leap_message(R"({"timestamp":5,"hands":[],"pointables":[]})", frame, faults),
            LeapMessage::Frame);
  EXPECT_TRUE(frame.hands.empty());
  EXPECT_DOUBLE_EQ(frame.time, 5e-6);
  EXPECT_EQ(leap_message(R"({"hands":[]})", frame, faults), LeapMessage::Refused);
  EXPECT_EQ(faults.count[static_cast<std::size_t>(HandFault::Time)], 1);
  EXPECT_EQ(faults.first,
            "a message of the tracker: \"timestamp\" is missing; it must be the time in "
            "microseconds");
}

/// Returns the message of a flat hand without bases, with its fingers bent at the knuckle by
/// `bend` and swung sideways by `swing` [rad], with noise of `noise` [m] at each joint.
nlohmann::json bent_fingers(Side side, double bend, double swing, double noise, unsigned seed) {
  HandFrame frame;
  make_study_hand({.side = side})->sample(0.0, frame);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, noise);
  Hand& hand = frame.hands.at(0);
  for (std::size_t base = kIndexMetacarpal; base < kJointCount; base += 5) {
    const Quat q = hand.orientation[base];
    const Vec3 along = q * Eigen::AngleAxisd(swing, Vec3::UnitY()) *
                       Eigen::AngleAxisd(-bend, Vec3::UnitX()) * -Vec3::UnitZ();
    for (std::size_t j = base + 2; j < base + 5; ++j) {
      hand.position[j] = hand.position[j - 1] + (j == base + 2 ? 0.04 : 0.02) * along;
      for (double& x : hand.position[j]) x += normal(random);
    }
  }
  nlohmann::json message = test::leap_json(frame);
  for (nlohmann::json& finger : message["pointables"]) finger.erase("bases");
  return message;
}

TEST(LeapFrame, FingersMayBendByAnyAngle) {
  constexpr double kDegree = 3.14159265358979 / 180.0;
  std::vector<Quat> last(kJointCount, Quat::Identity());
  for (const Side side : {Side::Left, Side::Right}) {
    for (const double swing : {-20.0, 0.0, 15.0}) {
      for (int bend = -30; bend <= 125; ++bend) {
        const auto seed = static_cast<unsigned>(bend + 30);
        HandFrame frame;
        HandFaults faults;
        const auto message =
            bent_fingers(side, bend * kDegree, swing * kDegree, bend % 2 == 0 ? 0.0 : 3e-4, seed);
        ASSERT_EQ(leap_message(message.dump(), frame, faults), LeapMessage::Frame);
        ASSERT_FALSE(faults.any()) << bend << ": " << faults.first;
        const Hand& hand = frame.hands.at(0);
        for (std::size_t base = kIndexMetacarpal; base < kJointCount; base += 5) {
          const std::size_t knuckle = base + 1;
          const Vec3 bone = (hand.position[knuckle + 1] - hand.position[knuckle]).normalized();
          EXPECT_GT(bone.dot(hand.orientation[knuckle] * -Vec3::UnitZ()), 0.9999);
          // the frame rotates with the finger and never flips
          if (bend > -30) {
            EXPECT_LT(hand.orientation[knuckle].angularDistance(last[knuckle]), 25.0 * kDegree)
                << bend << " " << swing;
          }
          last[knuckle] = hand.orientation[knuckle];
        }
      }
    }
  }
}

/// Bends and swings every joint of a flat hand at random within the human range, which includes
/// fists, grasps, pinches and crossed fingers, and rotates the hand. Frames follow their bones.
Hand any_posture(Side side, std::mt19937& random) {
  constexpr double kDegree = 3.14159265358979 / 180.0;
  const auto draw = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random) * kDegree;
  };
  HandFrame frame;
  make_study_hand({.side = side})->sample(0.0, frame);
  Hand hand = frame.hands.at(0);
  const Hand flat = hand;
  // flexion of the knuckle and of the two joints beyond it; the thumb has its own first bone
  const auto bend = [&](std::size_t knuckle, std::array<double, 3> flexion, double swing) {
    Quat turn(Eigen::AngleAxisd(swing, flat.orientation[knuckle] * Vec3::UnitY()));
    for (std::size_t b = 0; b < 3; ++b) {
      const std::size_t j = knuckle + b;
      turn = turn * Quat(Eigen::AngleAxisd(-flexion[b], flat.orientation[j] * Vec3::UnitX()));
      hand.orientation[j] = turn * flat.orientation[j];
      hand.position[j + 1] = hand.position[j] + turn * (flat.position[j + 1] - flat.position[j]);
    }
    hand.orientation[knuckle + 3] = hand.orientation[knuckle + 2];
  };
  for (std::size_t base = kIndexMetacarpal; base < kJointCount; base += 5)
    bend(base + 1, {draw(-30, 110), draw(0, 120), draw(-10, 90)}, draw(-25, 25));
  bend(kThumbMetacarpal, {draw(-20, 50), draw(-10, 70), draw(-20, 90)}, draw(-20, 40));
  std::normal_distribution<double> normal;
  const Vec3 axis(normal(random), normal(random), normal(random));
  const Quat whole(Eigen::AngleAxisd(draw(-180, 180), axis.normalized()));
  for (std::size_t j = 0; j < kJointCount; ++j) {
    hand.position[j] = flat.position[kPalm] + whole * (hand.position[j] - flat.position[kPalm]);
    hand.orientation[j] = whole * hand.orientation[j];
  }
  return hand;
}

TEST(LeapFrame, EveryPostureIsReadWithAndWithoutBases) {
  std::mt19937 random(11);
  for (std::uint64_t round = 0; round < test::reduced(4000); ++round) {
    const Side side = round % 2 == 0 ? Side::Left : Side::Right;
    std::normal_distribution<double> noise(0.0, round % 3 == 0 ? 1e-12 : 4e-4);
    HandFrame sent;
    sent.hands.push_back(any_posture(side, random));
    for (Vec3& x : sent.hands[0].position)
      for (double& value : x) value += noise(random);
    nlohmann::json message = test::leap_json(sent);
    if (round % 4 < 2)
      for (nlohmann::json& finger : message["pointables"]) finger.erase("bases");
    HandFrame frame;
    HandFaults faults;
    ASSERT_EQ(leap_message(message.dump(), frame, faults), LeapMessage::Frame);
    ASSERT_FALSE(faults.any()) << "round " << round << ": " << faults.first;
    const Hand& hand = frame.hands.at(0);
    for (std::size_t j = 0; j < kJointCount; ++j) {
      ASSERT_TRUE(hand.orientation[j].coeffs().allFinite());
      ASSERT_NEAR(hand.orientation[j].norm(), 1.0, 1e-6);
    }
  }
}

TEST(LeapFrame, AFistIsNotDiscarded) {
  nlohmann::json fist = bent_fingers(Side::Right, 1.72, 0.0, 0.0, 1),
                 flat = bent_fingers(Side::Left, 0.0, 0.0, 0.0, 1);
  flat["hands"][0]["id"] = 9;
  for (nlohmann::json& finger : flat["pointables"]) {
    finger["handId"] = 9;
    finger["id"] = 90 + finger["type"].get<int>();
    fist["pointables"].push_back(finger);
  }
  fist["hands"].push_back(flat["hands"][0]);
  HandFrame frame;
  HandFaults faults;
  EXPECT_EQ(leap_message(fist.dump(), frame, faults), LeapMessage::Frame);
  EXPECT_EQ(frame.hands.size(), 2u);
  EXPECT_FALSE(faults.any()) << faults.first;
}

}  // namespace
}  // namespace prostm
