#include "prostm/track/calibration_guide.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "prostm/core/random.hpp"
#include "prostm/track/hand_source.hpp"

namespace prostm {
namespace {

using testing::HasSubstr;

const std::vector<Vec3> kTransducers = {{-0.08, -0.08, 0.0},
                                        {0.08, -0.08, 0.0},
                                        {0.0, 0.0, 0.0},
                                        {-0.08, 0.08, 0.0},
                                        {0.08, 0.08, 0.0}};

/// Returns a hand whose index tip is at p_T.
HandFrame pointing(const Vec3& p_T, std::size_t hands = 1) {
  HandFrame frame;
  make_scripted_hand({}, {})->sample(5.0, frame);
  const Vec3 move = p_T - frame.hands[0].position[kIndexTip];
  for (Vec3& p : frame.hands[0].position) p += move;
  while (frame.hands.size() < hands) frame.hands.push_back(frame.hands[0]);
  if (hands == 0) frame.hands.clear();
  return frame;
}

TEST(CalibrationGuide, LeadsFromMarkToMarkToThePose) {
  Pose X_DT = default_tracker_pose();
  X_DT.rotate(Eigen::AngleAxisd(0.2, Vec3(1, 2, 3).normalized()));
  X_DT.translation() = Vec3(0.02, 0.15, -0.01);
  CalibrationGuide guide(kTransducers);
  ASSERT_EQ(guide.marks().size(), 4u);
  EXPECT_THAT(guide.solve(), HasSubstr("there are 0 calibration points"));
  Random random(1);
  double time = 0.0;
  for (int mark = 0; mark < 4; ++mark) {
    const CalibrationMark& at = guide.marks()[static_cast<std::size_t>(mark)];
    EXPECT_THAT(guide.sentence(), HasSubstr("Touch " + at.name));
    // the tracker's view of a finger whose flesh touches the mark, with 1 mm of noise
    const double flesh = pointing(Vec3::Zero()).hands[0].radius[kIndexTip];
    const Vec3 tip = X_DT.inverse() * (at.p_D + flesh * Vec3::UnitZ());
    time += 10.0;
    for (int i = 0; i < 60; ++i, time += 0.02) {
      guide.watch(time,
                  pointing(tip + 0.001 * Vec3(random.normal(), random.normal(), random.normal())));
    }
    EXPECT_EQ(guide.take(mark), "");
    EXPECT_TRUE(guide.marks()[static_cast<std::size_t>(mark)].taken);
    EXPECT_NEAR(guide.marks()[static_cast<std::size_t>(mark)].spread, 0.0017, 0.0008);
  }
  EXPECT_THAT(guide.sentence(), HasSubstr("solve"));
  EXPECT_EQ(guide.solve(), "");
  ASSERT_TRUE(guide.result());
  EXPECT_LT((guide.result()->X_DT.translation() - X_DT.translation()).norm(), 0.002);
  EXPECT_LT((guide.result()->X_DT.linear() - X_DT.linear()).norm(), 0.02);
  EXPECT_THAT(guide.sentence(), HasSubstr("mm rms"));
  // taking a mark again requires solving again
  EXPECT_EQ(guide.take(0), "");
  EXPECT_FALSE(guide.result());
}

TEST(CalibrationGuide, AcceptsOnlyOneFingerAtRest) {
  CalibrationGuide guide(kTransducers);
  EXPECT_THAT(guide.take(4), HasSubstr("there is no mark 4"));
  EXPECT_THAT(guide.take(-1), HasSubstr("there is no mark"));
  EXPECT_THAT(guide.take(0), HasSubstr("no hand"));
  for (int i = 0; i < 30; ++i) guide.watch(0.02 * i, pointing(Vec3(0.03 * (i % 2), 0, 0)));
  EXPECT_THAT(guide.take(0), HasSubstr("the finger moved by 15.0 mm"));
  guide.watch(1.0, pointing(Vec3::Zero(), 2));
  EXPECT_THAT(guide.take(0), HasSubstr("two hands"));
  guide.watch(1.1, pointing(Vec3::Zero(), 0));
  EXPECT_THAT(guide.take(0), HasSubstr("no hand"));
  // earlier frames are ignored
  for (int i = 0; i < 3; ++i) guide.watch(1.2 + 0.02 * i, pointing(Vec3::Zero()));
  EXPECT_THAT(guide.take(0), HasSubstr("long enough"));
  for (int i = 0; i < 10; ++i) guide.watch(1.3 + 0.02 * i, pointing(Vec3::Zero()));
  EXPECT_EQ(guide.take(0), "");
  EXPECT_FALSE(guide.marks()[1].taken);
  EXPECT_THROW(CalibrationGuide({}), std::invalid_argument);
}

}  // namespace
}  // namespace prostm
