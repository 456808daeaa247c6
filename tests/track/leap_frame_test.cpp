#include "prostm/track/live/leap_frame.hpp"

#include <gtest/gtest.h>

#include "leap_json.hpp"
#include "prostm/track/hand_source.hpp"

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

TEST(LeapFrame, BasesOfLeftHandsMayBeOfEitherHand) {
  for (const bool left : {false, true}) {
    const HandFrame sent = scripted(left);
    for (const bool mirrored : {false, true}) {
      HandFrame frame;
      std::string problem;
      ASSERT_EQ(leap_message(test::leap_json(sent, mirrored).dump(), frame, problem),
                LeapMessage::Frame)
          << problem;
      const Hand &a = frame.hands.at(0), &b = sent.hands.at(0);
      EXPECT_EQ(a.side, b.side);
      EXPECT_EQ(a.inferred, 0u);
      for (std::size_t j = kWrist; j < kJointCount; ++j) {
        EXPECT_LT((a.position[j] - b.position[j]).norm(), 1e-9);
        EXPECT_EQ(a.velocity[j], Vec3::Zero());
        // the tips turn with their last bones, as in the skeleton
        EXPECT_LT(a.orientation[j].angularDistance(b.orientation[j]), 1e-6) << j;
      }
    }
  }
}

TEST(LeapFrame, GreetingsAndEventsAreNoFrames) {
  HandFrame frame;
  std::string problem;
  for (const char* text :
       {R"({"serviceVersion":"2.3.1+33747","version":6})", R"({"version":6})",
        R"({"event":{"type":"deviceEvent","state":{"attached":true,"id":"x"}}})"}) {
    EXPECT_EQ(leap_message(text, frame, problem), LeapMessage::Other) << text;
  }
  EXPECT_EQ(leap_message(R"({"timestamp":5,"hands":[],"pointables":[]})", frame, problem),
            LeapMessage::Frame);
  EXPECT_TRUE(frame.hands.empty());
  EXPECT_DOUBLE_EQ(frame.time, 5e-6);
  EXPECT_EQ(leap_message(R"({"hands":[]})", frame, problem), LeapMessage::Refused);
  EXPECT_EQ(problem,
            "a message of the tracker: \"timestamp\" is missing; it must be the time in "
            "microseconds");
}

}  // namespace
}  // namespace prostm
