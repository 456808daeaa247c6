#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "prostm/core/units.hpp"
#include "prostm/track/hand_source.hpp"
#include "prostm/track/palm.hpp"

namespace prostm {
namespace {

/// The hand in D.
Hand hand_of(const StudyHandSettings& settings) {
  HandFrame frame;
  make_study_hand(settings)->sample(3.0, frame);
  to_device(default_tracker_pose(), frame);
  return frame.hands.at(0);
}

TEST(StudyHand, IsFlatClosedAndLevelWithItsPalmTowardsTheArray) {
  const Hand hand = hand_of({});
  const Palm palm = palm_of(hand);
  EXPECT_LT((palm.centre - Vec3(0, 0, 0.215)).norm(), 1e-12);
  EXPECT_NEAR(palm.yaw, 0.0, 0.05);
  EXPECT_LT(palm.tilt, 2.0 * kPi / 180.0);
  EXPECT_NEAR(palm.straightness, 1.0, 1e-6);
  EXPECT_NEAR(palm.size, 1.0, 0.02);
  for (const Vec3& v : hand.velocity) EXPECT_EQ(v.norm(), 0.0);
  // dorsal points away from the array
  EXPECT_GT((hand.orientation[kPalm] * Vec3::UnitY()).z(), 0.99);
  // tips of neighbours touch, within 2 mm of flesh
  const int tips[] = {kIndexTip, kMiddleTip, kRingTip, kLittleTip};
  for (int f = 0; f < 3; ++f) {
    const auto a = static_cast<std::size_t>(tips[f]), b = static_cast<std::size_t>(tips[f + 1]);
    const double apart = std::abs(hand.position[a].x() - hand.position[b].x());
    EXPECT_NEAR(apart, hand.radius[a] + hand.radius[b], 0.002);
  }
}

TEST(StudyHand, OrientationsPointAlongTheBones) {
  for (const Side side : {Side::Left, Side::Right}) {
    const Hand hand = hand_of({.size = 0.9, .side = side});
    for (const int base : {kThumbMetacarpal, kIndexMetacarpal, kLittleMetacarpal}) {
      for (int b = 0; b < 3; ++b) {
        const auto j = static_cast<std::size_t>(base + b);
        const Vec3 bone = (hand.position[j + 1] - hand.position[j]).normalized();
        EXPECT_LT((hand.orientation[j] * -Vec3::UnitZ() - bone).norm(), 1e-9)
            << joint_name(base + b);
      }
    }
  }
}

TEST(StudyHand, AllLengthsScaleWithItsSizeAndALeftHandIsTheMirrorImage) {
  const Hand one = hand_of({}), small = hand_of({.size = 0.8}),
             left = hand_of({.side = Side::Left});
  EXPECT_EQ(left.side, Side::Left);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const Vec3 from = one.position[j] - one.position[kPalm];
    EXPECT_LT((small.position[j] - small.position[kPalm] - 0.8 * from).norm(), 1e-12);
    EXPECT_NEAR(small.radius[j], 0.8 * one.radius[j], 1e-12);
    EXPECT_LT(
        (left.position[j] - Vec3(-one.position[j].x(), one.position[j].y(), one.position[j].z()))
            .norm(),
        1e-12);
  }
  EXPECT_NEAR(palm_of(small).size, 0.8 * palm_of(one).size, 1e-9);
}

TEST(StudyHand, RejectsSettingsOutOfBounds) {
  EXPECT_THROW(make_study_hand({.size = 0.5}), std::invalid_argument);
  EXPECT_THROW(make_study_hand({.height = 1.0}), std::invalid_argument);
}

TEST(Palm, MeasuresHowAHandIsTurnedTiltedAndBent) {
  Hand hand = hand_of({});
  const Palm before = palm_of(hand);
  const Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(0.4, Vec3::UnitZ()) * Eigen::AngleAxisd(0.3, Vec3::UnitY()))
          .toRotationMatrix();
  for (Vec3& p : hand.position) p = turn * p;
  const Palm after = palm_of(hand);
  EXPECT_NEAR(after.tilt, 0.3, 0.02);
  EXPECT_NEAR(after.yaw - before.yaw, 0.4, 0.02);
  EXPECT_NEAR(after.size, before.size, 1e-12);

  ScriptedHandSettings closes;
  HandFrame frame;
  double least = 1.0;
  const auto source = make_scripted_hand(closes, {});
  for (double t = 14.0; t < 16.0; t += 0.1) {
    source->sample(t, frame);
    least = std::min(least, palm_of(frame.hands.at(0)).straightness);
  }
  EXPECT_LT(least, 0.6) << "a fist";
}

}  // namespace
}  // namespace prostm
