#include "prostm/track/hand_frame.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace prostm {
namespace {

TEST(HandFrame, JointNamesMatchOpenXrAndAreDistinct) {
  EXPECT_EQ(joint_name(kPalm), "palm");
  EXPECT_EQ(joint_name(kThumbDistal), "thumb-distal");
  EXPECT_EQ(joint_name(kLittleTip), "little-tip");
  std::set<std::string_view> names;
  for (int j = 0; j < kJointCount; ++j) names.insert(joint_name(j));
  EXPECT_EQ(names.size(), 26u);
  EXPECT_EQ(joint_name(-1), "none");
  EXPECT_EQ(joint_name(kJointCount), "none");
}

TEST(HandFrame, TheDefaultPoseMapsUpInTheTrackerToAwayFromTheArray) {
  const Pose X_DT = default_tracker_pose();
  EXPECT_TRUE((X_DT * Vec3(1, 2, 3)).isApprox(Vec3(1, -3, 2)));
  EXPECT_NEAR(X_DT.linear().determinant(), 1.0, 1e-15);
  EXPECT_TRUE((ultraleap_kit_pose() * Vec3(1, 2, 3)).isApprox(Vec3(1, -2.879, 2)));
}

TEST(HandFrame, ToDeviceTransformsPositionsVelocitiesAndOrientations) {
  HandFrame frame;
  frame.hands.emplace_back();
  Hand& hand = frame.hands[0];
  hand.position.fill(Vec3(0.1, 0.2, 0.3));
  hand.velocity.fill(Vec3(1, 2, 3));
  hand.orientation.fill(Quat::Identity());
  to_device(ultraleap_kit_pose(), frame);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    EXPECT_TRUE(hand.position[j].isApprox(Vec3(0.1, -0.179, 0.2)));
    EXPECT_TRUE(hand.velocity[j].isApprox(Vec3(1, -3, 2)));
    // the bone's direction −z in T becomes +y in D, dorsal +y becomes +z
    EXPECT_TRUE((hand.orientation[j] * Vec3(0, 0, -1)).isApprox(Vec3(0, 1, 0)));
    EXPECT_TRUE((hand.orientation[j] * Vec3(0, 1, 0)).isApprox(Vec3(0, 0, 1)));
  }
}

}  // namespace
}  // namespace prostm
