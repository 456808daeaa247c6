#include "prostm/acoustics/array/array_units.hpp"

#include <gtest/gtest.h>

#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"

namespace prostm {
namespace {

Pose pose_of(Random& random) {
  Pose X = Pose::Identity();
  X.rotate(Eigen::AngleAxisd(random.uniform(-kPi, kPi), Vec3(1, 2, 3).normalized()));
  X.translation() = Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  return X;
}

TEST(ArrayUnits, AreFoundAtAnyPose) {
  Random random(3);
  for (int trial = 0; trial < 50; ++trial) {
    const TransducerArray unit = trial % 2 == 0 ? autd3_array() : usx_array();
    std::vector<TransducerArray> placed;
    std::vector<Pose> poses;
    for (int i = 0; i < 1 + trial % 4; ++i) {
      poses.push_back(pose_of(random));
      poses.back().translation().x() += 3.0 * i;  // far enough apart
      placed.push_back(place(unit, poses.back()));
    }
    const std::vector<ArrayUnit> units = units_of(join(placed));
    ASSERT_EQ(units.size(), placed.size());
    const ArrayUnit alone = units_of(unit).front();
    for (std::size_t i = 0; i < units.size(); ++i) {
      EXPECT_EQ(units[i].first, i * unit.position.size());
      EXPECT_EQ(units[i].count, unit.position.size());
      EXPECT_LT((units[i].centre - poses[i] * alone.centre).norm(), 1e-9);
      EXPECT_LT((units[i].normal - poses[i].linear() * Vec3::UnitZ()).norm(), 1e-9);
    }
  }
}

TEST(ArrayUnits, AMissingTransducerMakesTheArrayOneUnit) {
  const std::vector<TransducerArray> two = {
      autd3_array(), place(autd3_array(), Pose(Eigen::Translation3d(0.3, 0.0, 0.0)))};
  TransducerArray array = join(two);
  ASSERT_EQ(units_of(array).size(), 2U);
  array.position[300].y() += 1e-3;
  EXPECT_EQ(units_of(array).size(), 1U);
  array = join(two);
  array.position.pop_back();
  array.normal.pop_back();
  EXPECT_EQ(units_of(array).size(), 1U);
}

}  // namespace
}  // namespace prostm
