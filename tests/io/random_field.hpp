#pragma once
/// Random target fields for round trips.

#include <Eigen/Geometry>
#include <algorithm>

#include "prostm/core/random.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm::test {

/// Returns skin with gaps, pressures over many orders of magnitude, heights, weights in half of the
/// fields, and a tilted plane; all lengths are exact in files.
inline TargetField random_field(Random& random) {
  TargetField field;
  field.resize(1 + random.below(20), 1 + random.below(20));
  field.cell = (1 + random.below(100)) / 10.0 / 1000.0;
  const auto length = [&] { return (random.below(400000) - 200000) / 1000.0 / 1000.0; };
  field.origin = Vec2(length(), length());
  for (std::size_t i = 0; i < field.size(); ++i) {
    if (random.uniform() < 0.3) continue;
    field.skin[i] = 1;
    field.pressure[i] = std::exp(random.uniform(-50.0, 50.0));
    field.height[i] = (random.below(40000) - 20000) / 1000.0 / 1000.0;
  }
  const bool has_skin = std::count(field.skin.begin(), field.skin.end(), 1) > 0;
  if (has_skin && random.uniform() < 0.5) {
    field.weight.assign(field.size(), 0.0);
    for (std::size_t i = 0; i < field.size(); ++i) {
      if (field.skin[i] != 0) field.weight[i] = std::exp(random.uniform(-50.0, 50.0));
    }
  }
  fill_heights(field);
  const Quat q =
      Quat(random.normal(), random.normal(), random.normal(), random.normal()).normalized();
  field.X_DP.linear() = q.toRotationMatrix();
  // the field's plane has its normal along the array's
  if (field.X_DP.linear()(2, 2) < 0.0) field.X_DP.rotate(Quat(0.0, 1.0, 0.0, 0.0));
  field.X_DP.translation() = Vec3(length(), length(), length());
  return field;
}

}  // namespace prostm::test
