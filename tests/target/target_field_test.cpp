#include "prostm/target/target_field.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>

#include "prostm/core/random.hpp"
#include "support/heap_guard.hpp"

namespace prostm {
namespace {

TargetField palm(int rows, int cols) {
  TargetField field;
  field.resize(rows, cols);
  field.cell = 5e-3;
  field.origin = Vec2(-0.01, 0.02);
  for (std::size_t i = 0; i < field.size(); ++i) {
    field.skin[i] = 1;
    field.pressure[i] = static_cast<double>(i);
    field.height[i] = 1e-3 * static_cast<double>(i);
  }
  return field;
}

// Returns random islands of skin with random heights.
TargetField islands(Random& random) {
  TargetField field;
  field.resize(1 + random.below(12), 1 + random.below(12));
  field.cell = 5e-3;
  const double share = random.uniform();
  for (std::size_t i = 0; i < field.size(); ++i) {
    field.height[i] = 99.0;  // in cells without skin, to be overwritten
    if (random.uniform() < share) {
      field.skin[i] = 1;
      field.height[i] = random.uniform(-0.02, 0.02);
    }
  }
  return field;
}

TEST(TargetField, ResizeClearsAndAllocatesOnlyToGrow) {
  TargetField field = palm(6, 4);
  field.weight.assign(field.size(), 2.0);
  const test::HeapGuard guard;
  field.resize(4, 5);
  EXPECT_TRUE(field.weight.empty());
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_EQ(field.size(), 20u);
  for (std::size_t i = 0; i < field.size(); ++i) {
    EXPECT_EQ(field.pressure[i], 0.0);
    EXPECT_EQ(field.skin[i], 0);
    EXPECT_EQ(field.height[i], 0.0);
  }
}

TEST(TargetField, IsRowMajorFromItsOrigin) {
  const TargetField field = palm(3, 4);
  EXPECT_EQ(field.index(2, 1), 9u);
  EXPECT_TRUE(field.position(2, 1).isApprox(Vec2(-0.005, 0.03)));
}

TEST(TargetField, DefaultPlaneIsParallelToTheArray200mmAboveIt) {
  const Pose X_DP = TargetField::default_plane();
  EXPECT_TRUE((X_DP * Vec3(0.01, 0.02, 0.003)).isApprox(Vec3(0.01, 0.02, 0.203)));
}

struct Damage {
  const char* name;
  std::function<void(TargetField&)> apply;
  const char* message;
};

TEST(Validate, ReportsTheFault) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  const Damage damages[] = {
      {"no rows", [](TargetField& f) { f.resize(0, 4); }, "at least one row"},
      {"negative columns", [](TargetField& f) { f.cols = -4; }, "at least one row"},
      {"too large", [](TargetField& f) { f.rows = f.cols = 20000; }, "at most 1000000 cells"},
      {"sizes disagree", [](TargetField& f) { f.pressure.pop_back(); }, "not 11, 12 and 12"},
      {"skin disagrees", [](TargetField& f) { f.skin.push_back(1); }, "not 12, 13 and 12"},
      {"heights disagree", [](TargetField& f) { f.height.clear(); }, "not 12, 12 and 0"},
      {"zero cell", [](TargetField& f) { f.cell = 0; }, "cell = 0 m must be positive"},
      {"negative cell", [](TargetField& f) { f.cell = -0.005; }, "cell = -0.005 m"},
      {"NaN cell", [](TargetField& f) { f.cell = kNan; }, "cell = nan m"},
      {"infinite origin", [](TargetField& f) { f.origin.y() = kInf; }, "origin must be finite"},
      {"negative pressure", [](TargetField& f) { f.pressure[7] = -2; },
       "pressure = -2 at row 1, column 3"},
      {"NaN pressure", [](TargetField& f) { f.pressure[0] = kNan; }, "pressure = nan at row 0"},
      {"infinite pressure", [](TargetField& f) { f.pressure[11] = kInf; }, "row 2, column 3"},
      {"pressure off skin", [](TargetField& f) { f.skin[5] = 0; }, "because there is no skin"},
      {"NaN height", [](TargetField& f) { f.height[4] = kNan; },
       "height = nan m at row 1, column 0"},
      {"NaN plane", [](TargetField& f) { f.X_DP.linear()(0, 0) = kNan; }, "pose must be finite"},
      {"scaled plane", [](TargetField& f) { f.X_DP.linear() *= 1.001; }, "orthonormal"},
      {"huge plane", [](TargetField& f) { f.X_DP.linear() *= 1e300; }, "orthonormal"},
      {"mirrored plane", [](TargetField& f) { f.X_DP.linear().col(0) *= -1.0; }, "right-handed"},
      {"weights disagree", [](TargetField& f) { f.weight.assign(11, 1.0); },
       "as many weights or none, not 11"},
      {"negative weight", [](TargetField& f) { f.weight.assign(12, -2.0); },
       "weight = -2 at row 0, column 0 must be at least 0 and finite"},
      {"infinite weight",
       [](TargetField& f) {
         f.weight.assign(12, 1.0);
         f.weight[7] = kInf;
       },
       "weight = inf at row 1, column 3"},
      {"no weight on skin",
       [](TargetField& f) {
         f.weight.assign(12, 0.0);
         f.weight[0] = 1.0;
         f.skin[0] = 0;
       },
       "weights that are 0 on all skin"},
  };
  EXPECT_NO_THROW(validate(palm(3, 4)));
  TargetField weighted = palm(3, 4);
  weighted.weight.assign(12, 0.0);
  weighted.weight[5] = 1e-300;
  EXPECT_NO_THROW(validate(weighted));
  // weights off the skin do not matter
  weighted.resize(3, 4);
  weighted.weight.assign(12, 0.0);
  EXPECT_NO_THROW(validate(weighted));
  for (const Damage& damage : damages) {
    TargetField field = palm(3, 4);
    damage.apply(field);
    try {
      validate(field);
      ADD_FAILURE() << damage.name << " was accepted";
    } catch (const std::invalid_argument& e) {
      EXPECT_THAT(e.what(), testing::HasSubstr(damage.message)) << damage.name;
    }
  }
}

TEST(TotalPressure, ConsidersOnlySkin) {
  TargetField field = palm(3, 4);
  const double all = std::accumulate(field.pressure.begin(), field.pressure.end(), 0.0);
  EXPECT_EQ(total_pressure(field), all);
  field.skin[11] = 0;
  EXPECT_EQ(total_pressure(field), all - 11.0);
}

TEST(MaxPressure, ConsidersOnlySkin) {
  TargetField field = palm(3, 4);
  EXPECT_EQ(max_pressure(field), 11.0);
  field.skin[11] = 0;
  EXPECT_EQ(max_pressure(field), 10.0);
  field.resize(3, 4);
  EXPECT_EQ(max_pressure(field), 0.0);
}

TEST(MaxWeight, ConsidersOnlySkin) {
  TargetField field = palm(3, 4);
  field.weight = field.pressure;
  EXPECT_EQ(max_weight(field), 11.0);
  field.skin[11] = 0;
  EXPECT_EQ(max_weight(field), 10.0);
}

TEST(FillHeights, GivesEveryCellTheHeightOfANearestSkinCell) {
  Random random(11);
  for (int trial = 0; trial < 300; ++trial) {
    const TargetField before = islands(random);
    TargetField after = before;
    fill_heights(after);
    EXPECT_EQ(after.skin, before.skin);
    for (int row = 0; row < before.rows; ++row) {
      for (int col = 0; col < before.cols; ++col) {
        // all skin cells at the smallest distance along rows and columns, by brute force
        int nearest = std::numeric_limits<int>::max();
        bool found = false;
        for (int pass = 0; pass < 2; ++pass) {
          for (int r = 0; r < before.rows; ++r) {
            for (int c = 0; c < before.cols; ++c) {
              if (before.skin[before.index(r, c)] == 0) continue;
              const int distance = std::abs(r - row) + std::abs(c - col);
              if (pass == 0) nearest = std::min(nearest, distance);
              found |= pass == 1 && distance == nearest &&
                       before.height[before.index(r, c)] == after.height[before.index(row, col)];
            }
          }
        }
        const bool any_skin = nearest != std::numeric_limits<int>::max();
        EXPECT_TRUE(any_skin ? found : after.height[before.index(row, col)] == 0.0);
      }
    }
  }
}

TEST(FillHeights, AllocatesNothingOnceItsQueueIsSized) {
  TargetField field = palm(20, 30);
  for (std::size_t i = 0; i < field.size(); i += 2) field.skin[i] = 0;
  std::vector<std::uint32_t> queue;
  fill_heights(field, queue);
  const test::HeapGuard guard;
  fill_heights(field, queue);
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(HeightAt, ReproducesAPlaneAndClampsAtTheBorder) {
  TargetField field = palm(7, 9);
  const auto plane = [](const Vec2& x) { return 0.01 + 0.3 * x.x() - 0.2 * x.y(); };
  for (int row = 0; row < field.rows; ++row) {
    for (int col = 0; col < field.cols; ++col) {
      field.height[field.index(row, col)] = plane(field.position(row, col));
    }
  }
  Random random(3);
  const Vec2 low = field.position(0, 0), high = field.position(6, 8);
  for (int trial = 0; trial < 1000; ++trial) {
    const Vec2 x(random.uniform(-0.05, 0.08), random.uniform(-0.05, 0.1));
    EXPECT_NEAR(height_at(field, x), plane(x.cwiseMax(low).cwiseMin(high)), 1e-15);
  }
  for (const Vec2& corner : {low, high})
    EXPECT_NEAR(height_at(field, corner), plane(corner), 1e-15);
}

TEST(HeightAt, WorksOnOneCellRowsAndColumns) {
  TargetField field = palm(1, 1);
  field.height[0] = 0.004;
  EXPECT_EQ(height_at(field, Vec2(5.0, -5.0)), 0.004);
  field = palm(1, 3);
  EXPECT_NEAR(height_at(field, field.position(0, 1) + Vec2(2.5e-3, 1.0)), 1.5e-3, 1e-15);
  field = palm(3, 1);
  EXPECT_NEAR(height_at(field, field.position(1, 0) + Vec2(1.0, 2.5e-3)), 1.5e-3, 1e-15);
}

}  // namespace
}  // namespace prostm
