#include "prostm/target/field_shape.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"
#include "support/heap_guard.hpp"

namespace prostm {
namespace {

struct Bell {
  Vec2 centre;
  double height;
};

constexpr double kWidth = 0.012;  // of a bell's Gaussian [m]

TargetField bells(const std::vector<Bell>& list, double cell = 0.002) {
  TargetField field;
  field.cell = cell;
  field.origin = Vec2(-0.05, -0.05);
  const int side = static_cast<int>(0.1 / cell) + 1;
  field.resize(side, side);
  for (std::size_t c = 0; c < field.size(); ++c) {
    field.skin[c] = 1;
    for (const Bell& bell : list)
      field.pressure[c] += bell.height * std::exp(-(field.position(c) - bell.centre).squaredNorm() /
                                                  (2.0 * kWidth * kWidth));
  }
  return field;
}

TEST(FieldShape, FindsFourBellsWithTheirBalanceAndSpacing) {
  const TargetField field = bells({{{-0.026, -0.026}, 1.0},
                                   {{0.026, -0.026}, 0.97},
                                   {{-0.026, 0.026}, 1.0},
                                   {{0.026, 0.026}, 0.9}});
  const FieldShape shape = FieldShapeMeter().measure(field);
  ASSERT_EQ(shape.count(), 4);
  EXPECT_NEAR(shape.balance, 0.9, 0.01);
  EXPECT_NEAR(shape.least_spacing, 0.052, 0.002);
  EXPECT_NEAR(shape.most_spacing, 0.052, 0.002);
  EXPECT_LT((shape.maxima[3].position - Vec2(0.026, 0.026)).norm(), 0.002);
  // two bells of height 1 and 52 mm apart join at 2 exp(−26²/2·12²)
  EXPECT_NEAR(shape.saddle, 2.0 * std::exp(-0.5 * std::pow(26.0 / 12.0, 2)), 0.02);
}

TEST(FieldShape, OneBellHasItsClosedFormAreaAndForce) {
  const FieldShape shape = FieldShapeMeter().measure(bells({{{0.0, 0.0}, 0.08}}, 0.001));
  EXPECT_EQ(shape.count(), 1);
  EXPECT_EQ(shape.balance, 1.0);
  EXPECT_EQ(shape.saddle, 0.0);
  EXPECT_NEAR(shape.area, kPi * kWidth * kWidth * 2.0 * std::log(2.0), 1e-5);
  EXPECT_NEAR(shape.force, 2.0 * kPi * kWidth * kWidth * 0.08, 1e-7);
}

TEST(FieldShape, ALowerBellCountsFromAThirdOfTheLargest) {
  EXPECT_EQ(FieldShapeMeter().measure(bells({{{-0.03, 0}, 1.0}, {{0.03, 0}, 0.36}})).count(), 2);
  EXPECT_EQ(FieldShapeMeter().measure(bells({{{-0.03, 0}, 1.0}, {{0.03, 0}, 0.34}})).count(), 1);
}

TEST(FieldShape, AnEmptyFieldHasNoShape) {
  EXPECT_EQ(FieldShapeMeter().measure(TargetField()).count(), 0);
  const FieldShape flat = FieldShapeMeter().measure(bells({}));
  EXPECT_EQ(flat.count(), 0);
  EXPECT_EQ(flat.force, 0.0);
}

/// The highest level at which two maxima are in one region of the cells above it, by flooding again
/// at every level.
double flooded_saddle(const TargetField& field, const FieldShape& shape) {
  std::vector<double> levels = field.pressure;
  std::sort(levels.rbegin(), levels.rend());
  const auto cell_of = [&](const Vec2& p) {
    const Vec2 q = (p - field.origin) / field.cell;
    return field.index(static_cast<int>(std::lround(q.y())), static_cast<int>(std::lround(q.x())));
  };
  for (const double level : levels) {
    for (const FieldShape::Maximum& from : shape.maxima) {
      std::vector<std::uint8_t> seen(field.size(), 0);
      std::vector<std::size_t> stack{cell_of(from.position)};
      if (field.pressure[stack[0]] < level) continue;
      seen[stack[0]] = 1;
      while (!stack.empty()) {
        const auto c = static_cast<int>(stack.back());
        stack.pop_back();
        for (int r = c / field.cols - 1; r <= c / field.cols + 1; ++r) {
          for (int q = c % field.cols - 1; q <= c % field.cols + 1; ++q) {
            if (r < 0 || q < 0 || r >= field.rows || q >= field.cols) continue;
            const std::size_t o = field.index(r, q);
            if (seen[o] != 0 || field.pressure[o] < level) continue;
            seen[o] = 1;
            stack.push_back(o);
          }
        }
      }
      for (const FieldShape::Maximum& to : shape.maxima) {
        if (&to != &from && seen[cell_of(to.position)] != 0) return level / shape.largest;
      }
    }
  }
  return 0.0;
}

TEST(FieldShape, ValleysMatchASlowFloodOnRandomFields) {
  Random random(5);
  FieldShapeMeter meter;
  int several = 0;
  for (int n = 0; n < 60; ++n) {
    std::vector<Bell> list;
    for (int b = 0; b < 5; ++b)
      list.push_back({Vec2(random.uniform(-0.04, 0.04), random.uniform(-0.04, 0.04)),
                      random.uniform(0.4, 1.0)});
    const TargetField field = bells(list, 0.004);
    const FieldShape shape = meter.measure(field);
    ASSERT_GE(shape.count(), 1);
    if (shape.count() < 2) continue;
    ++several;
    ASSERT_DOUBLE_EQ(shape.saddle, flooded_saddle(field, shape));
  }
  EXPECT_GT(several, 30);
}

TEST(FieldShape, MeasuringAllocatesNothing) {
  const TargetField field = bells({{{-0.026, 0.0}, 1.0}, {{0.026, 0.0}, 0.9}});
  FieldShapeMeter meter(field.size());
  const test::HeapGuard guard;
  EXPECT_EQ(meter.measure(field).count(), 2);
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace prostm
