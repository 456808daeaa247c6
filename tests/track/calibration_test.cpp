#include "prostm/track/calibration.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "prostm/core/random.hpp"

namespace prostm {
namespace {

Vec3 random_point(Random& random, double reach) {
  return {random.uniform(-reach, reach), random.uniform(-reach, reach),
          random.uniform(-reach, reach)};
}

Pose random_pose(Random& random) {
  Pose X = Pose::Identity();
  X.linear() = Quat(random.normal(), random.normal(), random.normal(), random.normal())
                   .normalized()
                   .toRotationMatrix();
  X.translation() = random_point(random, 0.5);
  return X;
}

std::vector<PointPair> pairs(const Pose& X_DT, std::size_t count, double noise, Random& random) {
  std::vector<PointPair> points(count);
  for (PointPair& pair : points) {
    pair.p_T = random_point(random, 0.15);
    pair.p_D = X_DT * pair.p_T;
    for (int axis = 0; axis < 3; ++axis) pair.p_D[axis] += noise * random.normal();
  }
  return points;
}

std::string refusal(const std::vector<PointPair>& points) {
  try {
    calibrate(points);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  ADD_FAILURE() << "bad points were accepted";
  return {};
}

TEST(Calibration, FindsAnyPoseFromExactPoints) {
  Random random(1);
  for (int n = 0; n < 300; ++n) {
    const Pose X_DT = random_pose(random);
    const auto points = pairs(X_DT, 4 + static_cast<std::size_t>(n % 5), 0.0, random);
    const Calibration found = calibrate(points);
    EXPECT_LT((found.X_DT.matrix() - X_DT.matrix()).norm(), 1e-9);
    EXPECT_NEAR(found.X_DT.linear().determinant(), 1.0, 1e-12);
    EXPECT_LT(found.largest, 1e-9);
  }
}

TEST(Calibration, ThreePointsAreEnoughAlsoInAPlaneOfTheArray) {
  // marks on the array itself: all at z = 0 of D
  const Pose X_DT = [] {
    Random random(2);
    return random_pose(random);
  }();
  std::vector<PointPair> points;
  for (const Vec3& p_D : {Vec3(-0.08, -0.08, 0), Vec3(0.08, -0.08, 0), Vec3(-0.08, 0.08, 0)})
    points.push_back({X_DT.inverse() * p_D, p_D});
  EXPECT_LT((calibrate(points).X_DT.matrix() - X_DT.matrix()).norm(), 1e-9);
}

TEST(Calibration, NoiseIsAveragedAndReported) {
  Random random(3);
  constexpr double kNoise = 0.002;
  double rms = 0.0, worst_move = 0.0;
  for (int n = 0; n < 200; ++n) {
    const Pose X_DT = random_pose(random);
    const auto points = pairs(X_DT, 12, kNoise, random);
    const Calibration found = calibrate(points);
    rms += found.rms / 200;
    EXPECT_GE(found.largest, found.rms);
    worst_move =
        std::max(worst_move, (found.X_DT * Vec3(0, 0.2, 0) - X_DT * Vec3(0, 0.2, 0)).norm());
  }
  // the pose uses up 6 of the 36 coordinates
  EXPECT_NEAR(rms, kNoise * std::sqrt(3.0 * (36.0 - 6.0) / 36.0), 0.05 * kNoise * std::sqrt(3.0));
  EXPECT_LT(worst_move, 3.0 * kNoise);
}

TEST(Calibration, NoiseInThreePointsOfAPlaneNeverMirrors) {
  Random random(4);
  for (int n = 0; n < 300; ++n) {
    const Pose X_DT = random_pose(random);
    std::vector<PointPair> points;
    for (const Vec3& p : {Vec3(0, 0, 0), Vec3(0.1, 0, 0), Vec3(0, 0.1, 0), Vec3(0.1, 0.1, 0)}) {
      points.push_back({X_DT.inverse() * p, p});
      for (int axis = 0; axis < 3; ++axis) points.back().p_T[axis] += 0.001 * random.normal();
    }
    EXPECT_LT((calibrate(points).X_DT.linear() - X_DT.linear()).norm(), 0.2);
  }
}

TEST(Calibration, RejectsPointsThatDoNotDetermineAPose) {
  Random random(5);
  const Pose X_DT = random_pose(random);
  auto points = pairs(X_DT, 2, 0.0, random);
  EXPECT_THAT(refusal(points), testing::HasSubstr("there are 2 calibration points"));
  EXPECT_THAT(refusal({points[0]}), testing::HasSubstr("there is 1 calibration point;"));
  EXPECT_THAT(refusal({}), testing::HasSubstr("needs at least 3"));
  points.clear();
  for (int i = 0; i < 5; ++i) {
    const Vec3 p = 0.05 * i * Vec3(1, 2, 3).normalized() + random_point(random, 0.002);
    points.push_back({p, X_DT * p});
  }
  EXPECT_THAT(refusal(points), testing::HasSubstr("of one line"));
  points = pairs(X_DT, 5, 0.0, random);
  for (PointPair& pair : points) pair.p_T.z() *= -1.0;
  EXPECT_THAT(refusal(points), testing::HasSubstr("mirror image"));
  points[1].p_D.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(points), testing::HasSubstr("not finite"));
}

}  // namespace
}  // namespace prostm
