#include "prostm/fields/fields.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "prostm/core/units.hpp"

namespace prostm::fields {
namespace {

/// Returns the mean position, weighted by pressure [m].
Vec2 mass_centre(const TargetField& field) {
  Vec2 sum = Vec2::Zero();
  double mass = 0.0;
  for (int row = 0; row < field.rows; ++row) {
    for (int col = 0; col < field.cols; ++col) {
      const double p = field.pressure[field.index(row, col)];
      sum += p * field.position(row, col);
      mass += p;
    }
  }
  return sum / mass;
}

/// Returns the root mean square difference over the cells, relative to the larger maximum.
double difference(const TargetField& a, const TargetField& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::pow(a.pressure[i] - b.pressure[i], 2);
  return std::sqrt(sum / static_cast<double>(a.size())) /
         std::max(max_pressure(a), max_pressure(b));
}

TEST(Fields, EveryFrameIsAValidTargetOnTheSameHand) {
  for (const Pattern pattern : kPatterns) {
    const TargetField first = make(pattern, 0);
    for (int frame = 0; frame < kFrames; ++frame) {
      const TargetField field = make(pattern, frame);
      ASSERT_NO_THROW(validate(field));
      EXPECT_EQ(field.skin, first.skin);
      EXPECT_GT(max_pressure(field), 0.1) << to_string(pattern) << ", frame " << frame;
      EXPECT_LT(max_pressure(field), 20.0) << to_string(pattern) << ", frame " << frame;
    }
  }
}

TEST(Fields, SequencesMoveSmoothly) {
  for (const Pattern pattern : kPatterns) {
    TargetField before = make(pattern, 0);
    const TargetField first = before;
    double step = 0.0, farthest = 0.0;
    for (int frame = 1; frame < kFrames; ++frame) {
      const TargetField field = make(pattern, frame);
      step = std::max(step, difference(field, before));
      farthest = std::max(farthest, difference(field, first));
      EXPECT_LT((mass_centre(field) - mass_centre(before)).norm(), 4e-3) << to_string(pattern);
      before = field;
    }
    EXPECT_LT(step, 0.09) << to_string(pattern);
    EXPECT_GT(farthest, 0.05) << to_string(pattern);
  }
}

TEST(Fields, AFinerRasterSamplesTheSamePattern) {
  for (const Pattern pattern : kPatterns) {
    const TargetField coarse = make(pattern, 7), fine = make(pattern, 7, 3 * kCells);
    EXPECT_NEAR(fine.cell, kCell / 3.0, 1e-15);
    for (int row = 0; row < kCells; ++row) {
      for (int col = 0; col < kCells; ++col) {
        // the middle one of nine cells has the same centre, up to rounding
        const std::size_t i = coarse.index(row, col), j = fine.index(3 * row + 1, 3 * col + 1);
        if (coarse.skin[i] == 0 || fine.skin[j] == 0) continue;
        EXPECT_NEAR(coarse.pressure[i], fine.pressure[j], 1e-9);
      }
    }
  }
}

TEST(Fields, MovedPatternsMoveByTheStatedDisplacement) {
  for (int frame = 1; frame < kFrames; ++frame) {
    EXPECT_NEAR((displacement(frame) - displacement(frame - 1)).norm(), kMovedStep, 1e-6);
  }
  for (const Pattern pattern : kPatterns) {
    const Vec2 start = mass_centre(moved(pattern, 0));
    for (const int frame : {1, 13, 25, 49, 50}) {
      const TargetField field = moved(pattern, frame);
      ASSERT_NO_THROW(validate(field));
      EXPECT_EQ(std::count(field.skin.begin(), field.skin.end(), 1), kMovedCells * kMovedCells);
      const Vec2 error = mass_centre(field) - start - displacement(frame);
      EXPECT_LT(error.norm(), 0.02e-3) << to_string(pattern) << ", frame " << frame;
      for (int i = 0; i < kMovedCells; ++i) {
        for (const std::size_t border : {field.index(0, i), field.index(kMovedCells - 1, i),
                                         field.index(i, 0), field.index(i, kMovedCells - 1)}) {
          EXPECT_EQ(field.pressure[border], 0.0);
        }
      }
    }
  }
}

TEST(Fields, ASecondContactAppearsAtOnce) {
  for (int which = 0; which < kAppearings; ++which) {
    const Appearing before = appearing(which, kAppearingFrame - 1),
                    after = appearing(which, kAppearingFrame);
    ASSERT_NO_THROW(validate(after.field));
    EXPECT_EQ(*std::max_element(before.second.begin(), before.second.end()), 0.0);
    const double peak = *std::max_element(after.second.begin(), after.second.end());
    EXPECT_GT(peak, 0.95);
    // far from the steady contact: nearly no pressure before the new contact appears there
    for (std::size_t i = 0; i < after.second.size(); ++i) {
      if (after.second[i] > 0.5) {
        EXPECT_LT(before.field.pressure[i], 0.1);
      }
    }
  }
}

}  // namespace
}  // namespace prostm::fields
