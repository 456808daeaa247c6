#include "prostm/track/live/page_hand.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <thread>

#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"
#include "support/heap_guard.hpp"

namespace prostm {
namespace {

constexpr double kStep = 0.02;

PagePose pose_at(const Vec3& p_D) {
  PagePose pose;
  pose.p_D = p_D;
  return pose;
}

/// Returns the hand at rest in `pose`, in D.
Hand resting(const PagePose& pose) {
  PageHand page{TrackSettings()};
  EXPECT_TRUE(page.place(pose));
  Hand hand;
  double age = 0.0;
  EXPECT_TRUE(page.sample(0.0, hand, age));
  return hand;
}

Vec3 along_fingers(const Hand& hand) {
  return (hand.position[kMiddleProximal] - hand.position[kMiddleMetacarpal]).normalized();
}

TEST(PageHand, RestsPalmDownWithItsFingersAlongY) {
  const Vec3 p(0.05, -0.03, 0.2);
  const Hand hand = resting(pose_at(p));
  EXPECT_LT((hand.position[kPalm] - p).norm(), 1e-12);
  EXPECT_GT(along_fingers(hand).y(), 0.999);
  EXPECT_GT((hand.orientation[kPalm] * Vec3::UnitY()).z(), 0.999) << "the back is up";
  EXPECT_LT(hand.position[kThumbTip].x(), p.x()) << "a right thumb is on the left";
  EXPECT_EQ(hand.side, Side::Right);
  for (const Vec3& v : hand.velocity) EXPECT_LT(v.norm(), 1e-9);
}

TEST(PageHand, ALeftHandIsTheMirrorImage) {
  PagePose pose = pose_at(Vec3(0, 0, 0.2));
  pose.closure = 0.4;
  const Hand right = resting(pose);
  pose.side = Side::Left;
  const Hand left = resting(pose);
  EXPECT_EQ(left.side, Side::Left);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    Vec3 mirrored = right.position[j];
    mirrored.x() *= -1.0;
    EXPECT_LT((left.position[j] - mirrored).norm(), 1e-12);
    // −z along the bone and +y dorsal hold for both hands
    for (const Vec3& axis : {Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
      Vec3 expected = right.orientation[j] * axis;
      expected.x() *= -1.0;
      EXPECT_LT((left.orientation[j] * axis - expected).norm(), 1e-12);
    }
    EXPECT_EQ(left.radius[j], right.radius[j]);
  }
}

TEST(PageHand, AnglesTurnAsDescribed) {
  PagePose pose = pose_at(Vec3(0, 0, 0.2));
  pose.yaw = 0.3;
  EXPECT_NEAR(along_fingers(resting(pose)).x(), -std::sin(0.3), 1e-3);
  pose = pose_at(Vec3(0, 0, 0.2));
  pose.pitch = 0.3;
  EXPECT_NEAR(along_fingers(resting(pose)).z(), std::sin(0.3), 1e-3);
  pose = pose_at(Vec3(0, 0, 0.2));
  pose.roll = 0.3;
  const Hand hand = resting(pose);
  EXPECT_NEAR((hand.orientation[kPalm] * Vec3::UnitX()).z(), -std::sin(0.3), 1e-12);
}

TEST(PageHand, UnevenMessagesGiveASmoothMotion) {
  // a pointer at 0.3 m/s, reported at about 60 Hz, sampled at 50 Hz
  const TrackSettings settings;
  PageHand page{settings};
  Random random(3);
  Hand hand;
  double age = 0.0, next = 0.0;
  Vec3 last = Vec3::Zero();
  for (int i = 0; i < 60; ++i) {
    const double time = kStep * i;
    for (; next <= time; next += random.uniform(0.010, 0.023)) {
      ASSERT_TRUE(page.place(pose_at(Vec3(0.3 * next - 0.15, 0, 0.2))));
    }
    ASSERT_TRUE(page.sample(time, hand, age));
    EXPECT_LE(age, kStep + 1e-12);
    const Vec3& p = hand.position[kPalm];
    if (i > 15) {
      EXPECT_NEAR((p - last).x() / kStep, 0.3, 0.10) << "stutters at " << time;
      EXPECT_NEAR(hand.velocity[kPalm].x(), 0.3, 0.10);
      // the spring's lag is 2/ω = 50 ms, and the pointer's newest message is up to 23 ms old
      EXPECT_NEAR(p.x(), 0.3 * time - 0.15, 0.3 * 0.080);
    }
    last = p;
  }
}

TEST(PageHand, AJumpOfThePointerIsFollowedAtTheLargestSpeed) {
  const TrackSettings settings;
  PageHand page{settings};
  Hand hand;
  double age = 0.0;
  ASSERT_TRUE(page.place(pose_at(Vec3(-0.5, -0.5, 0.0))));
  ASSERT_TRUE(page.sample(0.0, hand, age));
  const Vec3 to(0.5, 0.5, 0.5);
  Vec3 last = hand.position[kPalm];
  for (int i = 1; i <= 60; ++i) {
    ASSERT_TRUE(page.place(pose_at(to)));
    ASSERT_TRUE(page.sample(kStep * i, hand, age));
    EXPECT_LE((hand.position[kPalm] - last).norm(), settings.max_speed * kStep * (1 + 1e-9));
    for (const Vec3& v : hand.velocity) EXPECT_LE(v.norm(), settings.max_speed * (1 + 1e-9));
    last = hand.position[kPalm];
  }
  EXPECT_LT((last - to).norm(), 1e-6);
}

TEST(PageHand, YawTakesTheShortWay) {
  PageHand page{TrackSettings()};
  PagePose pose = pose_at(Vec3(0, 0, 0.2));
  Hand hand;
  double age = 0.0;
  pose.yaw = 3.0;
  ASSERT_TRUE(page.place(pose));
  ASSERT_TRUE(page.sample(0.0, hand, age));
  pose.yaw = -3.0;
  for (int i = 1; i < 40; ++i) {
    ASSERT_TRUE(page.place(pose));
    ASSERT_TRUE(page.sample(kStep * i, hand, age));
    EXPECT_LT(along_fingers(hand).y(), -0.95) << "the fingers never point forwards";
  }
  EXPECT_NEAR(along_fingers(hand).x(), -std::sin(-3.0), 1e-3);
}

TEST(PageHand, SilenceReleasesItUntilPosesArriveSteadily) {
  PageHand page{TrackSettings()};
  Hand hand;
  double age = 0.0;
  EXPECT_FALSE(page.sample(0.0, hand, age)) << "no page holds it yet";
  page.place(pose_at(Vec3(0, 0, 0.2)));
  ASSERT_TRUE(page.sample(1.0, hand, age));
  const std::int64_t id = hand.id;
  EXPECT_TRUE(page.sample(1.49, hand, age));
  EXPECT_NEAR(age, 0.49, 1e-12);
  EXPECT_FALSE(page.sample(1.51, hand, age));
  EXPECT_EQ(page.report().state, PageHandState::Late);
  EXPECT_EQ(page.report().late, 1);
  for (int i = 0; i <= 10; ++i) {
    page.place(pose_at(Vec3(0.1, 0, 0.2)));
    ASSERT_EQ(page.sample(2.0 + 0.1 * i, hand, age), i == 10) << i;
  }
  EXPECT_NE(hand.id, id);
  EXPECT_NEAR(hand.position[kPalm].x(), 0.1, 1e-12) << "it appears at the pointer";
}

/// The timers of a hidden page fire once a second, or once a minute, and sometimes in bursts.
TEST(PageHand, LateTimersReleaseItOnceAndNeverReturnIt) {
  for (const double period : {0.6, 1.0, 60.0}) {
    for (const int burst : {1, 5}) {
      PageHand page{TrackSettings()};
      Hand hand;
      double age = 0.0;
      int switches = 0;
      bool held = false;
      for (double next = 0.0, time = 0.0; time < 20.0 * period; time += kStep) {
        const double since = time - next;
        if (since >= 0.0 && since < burst * kStep) page.place(pose_at(Vec3(0, 0, 0.2)));
        if (since >= burst * kStep) next += period;
        if (held != page.sample(time, hand, age)) ++switches;
        held = page.report().state == PageHandState::Held;
      }
      EXPECT_EQ(switches, 2) << period << " s, " << burst << " messages";
      EXPECT_FALSE(held);
      EXPECT_EQ(page.report().late, 1);
    }
  }
}

TEST(PageHand, AReleasedHandIsTakenAgainAtOnce) {
  PageHand page{TrackSettings()};
  Hand hand;
  double age = 0.0;
  page.place(pose_at(Vec3(0, 0, 0.2)));
  ASSERT_TRUE(page.sample(0.0, hand, age));
  page.release();
  EXPECT_FALSE(page.sample(0.02, hand, age));
  EXPECT_EQ(page.report().state, PageHandState::Free);
  page.place(pose_at(Vec3(0, 0, 0.2)));
  EXPECT_TRUE(page.sample(0.04, hand, age));
  // also one that has lapsed
  EXPECT_FALSE(page.sample(1.0, hand, age));
  page.release();
  EXPECT_FALSE(page.sample(1.02, hand, age));
  page.place(pose_at(Vec3(0, 0, 0.2)));
  EXPECT_TRUE(page.sample(1.04, hand, age));
}

TEST(PageHand, ReportsThatItsPageIsHidden) {
  PageHand page{TrackSettings()};
  Hand hand;
  double age = 0.0;
  page.place(pose_at(Vec3(0, 0, 0.2)));
  ASSERT_TRUE(page.sample(0.0, hand, age));
  page.release(true);
  EXPECT_FALSE(page.sample(0.02, hand, age));
  EXPECT_EQ(page.report().state, PageHandState::Hidden);
  EXPECT_EQ(page.report().hidden, 1);
  page.place(pose_at(Vec3(0, 0, 0.2)));
  EXPECT_TRUE(page.sample(0.04, hand, age));
  page.release();
  EXPECT_FALSE(page.sample(0.06, hand, age));
  EXPECT_EQ(page.report().hidden, 1);
  EXPECT_EQ(page.report().late, 0);
}

TEST(PageHand, RejectsInvalidPositionsAndClampsAngles) {
  PageHand page{TrackSettings()};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Vec3& p :
       {Vec3(0.6, 0, 0.2), Vec3(0, -0.6, 0.2), Vec3(0, 0, 1e300), Vec3(0, nan, 0)}) {
    EXPECT_FALSE(page.place(pose_at(p)));
  }
  PagePose pose;
  pose.roll = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(page.place(pose));
  Hand hand;
  double age = 0.0;
  EXPECT_FALSE(page.sample(0.0, hand, age));
  pose.roll = 1e300;
  pose.pitch = pose.yaw = -1e9;
  pose.closure = 40.0;
  EXPECT_TRUE(page.place(pose));
  ASSERT_TRUE(page.sample(0.1, hand, age));
  for (const Vec3& p : hand.position) EXPECT_LT((p - pose.p_D).norm(), 0.25);
}

TEST(HandSwitch, GivesThePagesHandWhileItIsHeldAndTheOtherOtherwise) {
  const Pose X_DT = ultraleap_kit_pose();
  auto page = std::make_shared<PageHand>(TrackSettings());
  ScriptedHandSettings still;
  still.still = true;
  HandSwitch hands(make_scripted_hand(still, {}), page, X_DT);
  HandFrame frame;
  hands.sample(0.0, frame);
  ASSERT_EQ(frame.hands.size(), 1u);
  EXPECT_EQ(page->report().state, PageHandState::Free);
  const std::int64_t base = frame.hands[0].id;

  const Vec3 p_D(0.03, 0.02, 0.25);
  page->place(pose_at(p_D));
  hands.sample(0.02, frame);
  ASSERT_EQ(frame.hands.size(), 1u);
  EXPECT_EQ(page->report().state, PageHandState::Held);
  EXPECT_NE(frame.hands[0].id, base);
  EXPECT_EQ(frame.time, 0.02);
  to_device(X_DT, frame);
  EXPECT_LT((frame.hands[0].position[kPalm] - p_D).norm(), 1e-12);

  page->release();
  hands.sample(0.04, frame);
  ASSERT_EQ(frame.hands.size(), 1u);
  EXPECT_EQ(frame.hands[0].id, base);
  EXPECT_EQ(page->report().state, PageHandState::Free);

  HandSwitch alone(make_absent_hand(), page, X_DT);
  alone.sample(0.0, frame);
  EXPECT_TRUE(frame.hands.empty());
}

TEST(HandSwitch, SamplingDoesNotAllocateWhilePagesSendPoses) {
  auto page = std::make_shared<PageHand>(TrackSettings());
  HandSwitch hands(make_absent_hand(), page, default_tracker_pose());
  std::atomic<bool> stop{false};
  std::thread placing([&] {
    for (int i = 0; !stop; ++i) {
      if (i % 100 == 99) {
        page->release();
      } else {
        page->place(pose_at(Vec3(0.1 * std::sin(0.01 * i), 0, 0.2)));
      }
    }
  });
  HandFrame frame;
  test::HeapGuard guard;
  for (int i = 0; i < 2000; ++i) {
    hands.sample(kStep * i, frame);
    for (const Hand& hand : frame.hands) {
      for (const Vec3& p : hand.position) EXPECT_LT(p.norm(), 1.0);
    }
  }
  EXPECT_EQ(guard.allocations(), 0u);
  stop = true;
  placing.join();
}

}  // namespace
}  // namespace prostm
