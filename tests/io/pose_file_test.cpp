#include "prostm/io/hand/pose_file.hpp"

#include <gtest/gtest.h>

#include "prostm/core/file/file.hpp"
#include "prostm/core/random.hpp"
#include "prostm/track/hand_frame.hpp"
#include "support/input_errors.hpp"

namespace prostm {
namespace {

constexpr const char* kPose = R"({"format": "prostm-pose/1", "position_mm": [0, 121, -3.5],
  "quaternion": [0.70710678, 0, 0, 0.70710678]})";

TEST(PoseFile, ReadsAPoseAndWritesItBack) {
  const Calibration read = pose_from_json(kPose, "p.json");
  EXPECT_TRUE(read.X_DT.translation().isApprox(Vec3(0, 0.121, -0.0035)));
  // a quarter turn about x, for a tracker on the desk
  EXPECT_LT((read.X_DT.linear() - default_tracker_pose().linear()).norm(), 1e-7);
  EXPECT_EQ(read.rms, 0.0);

  Random random(1);
  const test::TemporaryFolder folder;
  for (int n = 0; n < 50; ++n) {
    Calibration pose;
    pose.X_DT.linear() = Quat(random.normal(), random.normal(), random.normal(), random.normal())
                             .normalized()
                             .toRotationMatrix();
    pose.X_DT.translation() = Vec3(random.normal(), random.normal(), random.normal());
    pose.rms = 0.001;
    pose.largest = 0.003;
    write_pose(folder.file("pose.json"), pose);
    const Calibration back = read_pose(folder.file("pose.json"));
    EXPECT_LT((back.X_DT.matrix() - pose.X_DT.matrix()).norm(), 1e-14);
    EXPECT_EQ(back.rms, pose.rms);
    EXPECT_EQ(back.largest, pose.largest);
  }
  EXPECT_LT((tracker_pose_from_name(folder.file("pose.json")).matrix() -
             read_pose(folder.file("pose.json")).X_DT.matrix())
                .norm(),
            1e-15);
}

TEST(PoseFile, NamesAreKnownOrRejected) {
  EXPECT_TRUE(tracker_pose_from_name("centre").isApprox(default_tracker_pose()));
  EXPECT_TRUE(tracker_pose_from_name("ultraleap-kit").isApprox(ultraleap_kit_pose()));
  EXPECT_EQ(tracker_pose_from_name("ultraleap-usi-kit").translation(), Vec3(0.0, -0.089, 0.0));
  EXPECT_EQ(tracker_pose_from_name("ultraleap-uhdk5-square-kit").translation().y(), 0.1105);
  EXPECT_EQ(tracker_pose_from_name("ultraleap-uhdk5-rectangular-kit").translation().y(), 0.163);
  EXPECT_THAT(test::input_error([] { tracker_pose_from_name("roof"); }),
              testing::HasSubstr("must be centre, ultraleap-kit, ultraleap-usi-kit"));
  EXPECT_THROW(tracker_pose_from_name("none.json"), InputError);
}

TEST(PoseFile, ReportsErrors) {
  const auto expect = [](const std::string& text, const std::string& part) {
    EXPECT_THAT(test::input_error([&] { pose_from_json(text, "p.json"); }),
                testing::HasSubstr(part));
  };
  expect("", "ends too early");
  expect(R"({"format": "prostm-plan/1"})", "prostm-pose/1");
  expect(R"({"format": "prostm-pose/1", "quaternion": [0, 0, 0, 1]})", "position_mm");
  expect(R"({"format": "prostm-pose/1", "position_mm": [0, 0, 0]})", "quaternion");
  expect(R"({"format": "prostm-pose/1", "position_mm": [0, 0], "quaternion": [0, 0, 0, 1]})",
         "must have 3");
  expect(R"({"format": "prostm-pose/1", "position_mm": [0, 0, 9000], "quaternion": [0, 0, 0, 1]})",
         "from -5000 to 5000");
  expect(R"({"format": "prostm-pose/1", "position_mm": [0, 0, 0], "quaternion": [0, 0, 1]})",
         "must have 4");
  expect(R"({"format": "prostm-pose/1", "position_mm": [0, 0, 0], "quaternion": [0, 0, 0, 0]})",
         "length 0");
  expect(R"({"format": "prostm-pose/1", "position_mm": [0, 0, 0], "quaternion": [0, 0, 1, "w"]})",
         "must be a number");
  expect(R"({"format": "prostm-pose/1", "position_mm": [0, 0, 0], "quaternion": [0, 0, 0, 1],
            "rms_mm": -1})",
         "from 0 to 1000");
}

}  // namespace
}  // namespace prostm
