#include "prostm/hand/hand_shape.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "prostm/core/random.hpp"
#include "prostm/io/hand/hand_file.hpp"
#include "prostm/track/hand_source.hpp"
#include "support/heap_guard.hpp"
#include "support/shared.hpp"

namespace prostm {
namespace {

Hand scripted_hand(double t) {
  HandFrame frame;
  make_scripted_hand({}, {})->sample(t, frame);
  return frame.hands.front();
}

double volume(const HandShape& shape, double cell) {
  std::size_t inside = 0;
  for (double x = shape.lower().x(); x < shape.upper().x(); x += cell) {
    for (double y = shape.lower().y(); y < shape.upper().y(); y += cell) {
      for (double z = shape.lower().z(); z < shape.upper().z(); z += cell) {
        inside += shape.distance(Vec3(x, y, z)) < 0.0 ? 1 : 0;
      }
    }
  }
  return static_cast<double>(inside) * cell * cell * cell;
}

TEST(HandShape, HasTheVolumeOfAHand) {
  EXPECT_GT(volume(HandShape(scripted_hand(4.0)), 0.003), 280e-6);
  EXPECT_LT(volume(HandShape(scripted_hand(4.0)), 0.003), 330e-6);
}

TEST(HandShape, EveryJointIsInsideInEveryPose) {
  for (const double t : {1.0, 4.0, 7.2, 11.5, 15.4, 19.0}) {
    const Hand hand = scripted_hand(t);
    const HandShape shape(hand);
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const SurfacePoint point = shape.query(hand.position[j]);
      EXPECT_LT(point.distance, -0.005) << joint_name(static_cast<int>(j));
      EXPECT_NEAR(point.normal.norm(), 1.0, 1e-12);
    }
  }
}

TEST(HandShape, PalmHasNoHoleBetweenTheMetacarpals) {
  const Hand hand = scripted_hand(4.0);
  const HandShape shape(hand);
  for (const int from : {kIndexMetacarpal, kMiddleMetacarpal, kRingMetacarpal}) {
    const auto a = static_cast<std::size_t>(from), b = a + 5;
    for (double u = 0.0; u <= 1.0; u += 0.1) {
      const Vec3 between = 0.5 * ((1 - u) * (hand.position[a] + hand.position[b]) +
                                  u * (hand.position[a + 1] + hand.position[b + 1]));
      EXPECT_LT(shape.distance(between), -0.008);
    }
  }
}

TEST(HandShape, QueryAgreesWithDistanceAndItsGradient) {
  const HandShape shape(scripted_hand(4.0));
  Random random(1);
  constexpr double kDelta = 1e-6;
  int creases = 0, outside = 0;
  for (int n = 0; n < 5000; ++n) {
    Vec3 p;
    for (int a = 0; a < 3; ++a)
      p[a] = random.uniform(shape.lower()[a] - 0.03, shape.upper()[a] + 0.03);
    const SurfacePoint point = shape.query(p);
    EXPECT_NEAR(point.distance, shape.distance(p), 1e-12);
    Vec3 gradient;
    for (int a = 0; a < 3; ++a) {
      const Vec3 d = kDelta * Vec3::Unit(a);
      gradient[a] = (shape.distance(p + d) - shape.distance(p - d)) / (2 * kDelta);
    }
    if (point.distance < 0.0) continue;
    ++outside;
    // the distance has a crease between two bodies, where the difference quotient fails
    if ((gradient - point.normal).norm() > 1e-4) ++creases;
  }
  EXPECT_GT(outside, 2000);
  EXPECT_LT(creases, 5);
}

TEST(HandShape, MovesAndRotatesWithTheHand) {
  const Hand hand = scripted_hand(4.0);
  const HandShape shape(hand);
  Pose X_DT = Pose::Identity();
  X_DT.linear() = Eigen::AngleAxisd(0.7, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  X_DT.translation() = Vec3(0.2, -0.1, 0.4);
  HandFrame frame;
  frame.hands.push_back(hand);
  for (std::size_t j = 0; j < kJointCount; ++j) frame.hands[0].velocity[j] = 0.1 * hand.position[j];
  const HandShape still(frame.hands[0]);
  to_device(X_DT, frame);
  const HandShape moved(frame.hands[0]);
  Random random(2);
  for (int n = 0; n < 2000; ++n) {
    Vec3 p;
    for (int a = 0; a < 3; ++a)
      p[a] = random.uniform(shape.lower()[a] - 0.02, shape.upper()[a] + 0.02);
    const SurfacePoint before = still.query(p), after = moved.query(X_DT * p);
    EXPECT_NEAR(before.distance, shape.distance(p), 1e-12);
    EXPECT_NEAR(before.distance, after.distance, 1e-12);
    if (before.distance < 0.0) continue;
    EXPECT_LT((X_DT.linear() * before.normal - after.normal).norm(), 1e-6);
    EXPECT_LT((X_DT.linear() * before.velocity - after.velocity).norm(), 1e-6);
  }
}

TEST(HandShape, DistinguishesTipsFingersAndPalm) {
  for (const double t : {1.0, 4.0, 11.5}) {
    const Hand hand = scripted_hand(t);
    const HandShape shape(hand);
    const auto between = [&](int joint) {
      const auto j = static_cast<std::size_t>(joint);
      return shape.region(0.5 * (hand.position[j] + hand.position[j + 1]));
    };
    for (const int knuckle : {kIndexProximal, kMiddleProximal, kRingProximal, kLittleProximal}) {
      EXPECT_EQ(between(knuckle), SkinRegion::Finger) << t;
      EXPECT_EQ(between(knuckle + 1), SkinRegion::Finger) << t;
      EXPECT_EQ(between(knuckle + 2), SkinRegion::Tip) << t;
    }
    EXPECT_EQ(between(kThumbProximal), SkinRegion::Finger) << t;
    EXPECT_EQ(between(kThumbDistal), SkinRegion::Tip) << t;
    for (const int joint : {kPalm, kWrist, kThumbMetacarpal, kMiddleMetacarpal}) {
      EXPECT_EQ(shape.region(hand.position[static_cast<std::size_t>(joint)]), SkinRegion::Palm);
    }
  }
}

TEST(HandShape, TheRegionOfAPointIsThatOfItsNearestBody) {
  const HandShape shape(scripted_hand(4.0));
  Random random(3);
  int counted[3] = {};
  for (int n = 0; n < 5000; ++n) {
    Vec3 p;
    for (int a = 0; a < 3; ++a)
      p[a] = random.uniform(shape.lower()[a] - 0.02, shape.upper()[a] + 0.02);
    double palm = 1e9, finger = 1e9, tip = 1e9;
    for (const SphereTriangle& triangle : shape.triangles())
      palm = std::min(palm, triangle.distance(p));
    for (std::size_t k = 0; k < shape.cones().size(); ++k) {
      double& own = k == 2 || k == 5 || k == 8 || k == 11 || k == 13 ? tip : finger;
      own = std::min(own, shape.cones()[k].distance(p));
    }
    const SkinRegion region = shape.region(p);
    const double nearest = std::min({palm, finger, tip});
    EXPECT_EQ(region == SkinRegion::Palm     ? palm
              : region == SkinRegion::Finger ? finger
                                             : tip,
              nearest);
    ++counted[static_cast<int>(region)];
  }
  for (const int count : counted) EXPECT_GT(count, 200);
}

TEST(HandShape, SettingDoesNotAllocate) {
  const Hand hand = scripted_hand(4.0);
  HandShape shape;
  test::HeapGuard guard;
  shape.set(hand);
  EXPECT_LT(shape.distance(hand.position[kPalm]), 0.0);
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(HandShape, RecordedHandsHaveTheVolumeOfHandsAndTheirJointsInside) {
  PROSTM_NEEDS_SHARED("data/hands/flapping.hands.jsonl");
  const HandRecording recording =
      read_hand_recording(test::shared_file("data/hands/flapping.hands.jsonl"));
  for (std::size_t i = 0; i < recording.frames.size(); i += 40) {
    for (const Hand& hand : recording.frames[i].hands) {
      const HandShape shape(hand);
      for (const Vec3& p : hand.position) EXPECT_LT(shape.distance(p), -0.004);
      const double v = volume(shape, 0.004);
      EXPECT_GT(v, 260e-6);
      EXPECT_LT(v, 380e-6);
    }
  }
}

}  // namespace
}  // namespace prostm
