#include "prostm/acoustics/field/focus_width.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "prostm/core/units.hpp"

namespace prostm {
namespace {

FocusWidth facing(const PackedArray& packed, const Vec3& focus) {
  return focus_width(packed, Medium(), focus, -Vec3::UnitZ(), Vec3::UnitX());
}

// A square aperture gives sin²X/X², X = 2π x sin α/λ. Its least-squares Gaussian is narrower than
// its half width by a known factor; this test checks only that it grows like (A6).
TEST(FocusWidth, GrowsWithHeightAsTheApertureRequires) {
  const PackedArray packed(usx_array(), Medium());
  const double half_side = 0.5 * 16 * 10.5e-3;
  const double at_300 = facing(packed, Vec3(0.0, 0.0, 0.3)).along;
  EXPECT_NEAR(at_300, 6.1e-3, 0.3e-3);
  for (const double z : {0.20, 0.25}) {
    const double sine = half_side / std::hypot(half_side, z),
                 sine_300 = half_side / std::hypot(half_side, 0.3);
    EXPECT_NEAR(facing(packed, Vec3(0.0, 0.0, z)).along, at_300 * sine_300 / sine, 0.03 * at_300);
  }
}

TEST(FocusWidth, IsRoundAboveTheMiddleAndWiderOffTheAxisAndOnATilt) {
  const PackedArray packed(usx_array(), Medium());
  const FocusWidth middle = facing(packed, Vec3(0.0, 0.0, 0.2));
  EXPECT_NEAR(middle.along, middle.across, 1e-3 * middle.along);
  EXPECT_NEAR(middle.sigma(), middle.along, 1e-3 * middle.along);
  const FocusWidth beside = facing(packed, Vec3(0.08, 0.0, 0.2));
  EXPECT_GT(beside.along, 1.1 * middle.along);
  EXPECT_LT(beside.level, middle.level);
  const double tilt = 40.0 * kPi / 180.0;
  const std::array<double, 1> heights{0.2}, offsets{0.0}, tilts{tilt};
  const FocusWidth tilted = focus_width_table(packed, Medium(), heights, offsets, tilts)[0].width;
  // the tilt stretches the beam's cross section as long as the beam is long enough
  EXPECT_GT(tilted.along, 1.15 * middle.along);
  EXPECT_LT(tilted.along, 1.02 * middle.along / std::cos(tilt));
  EXPECT_NEAR(tilted.across, middle.across, 0.03 * middle.across);
  EXPECT_NEAR(tilted.level, std::pow(std::cos(tilt), 2) * middle.level, 0.01 * middle.level);
}

TEST(FocusWidth, TableCoversAllCombinations) {
  const PackedArray packed(autd3_array(), Medium());
  const std::array<double, 2> heights{0.15, 0.25}, offsets{0.0, 0.05};
  const std::array<double, 3> tilts{0.0, 0.3, 0.6};
  const auto table = focus_width_table(packed, Medium(), heights, offsets, tilts);
  ASSERT_EQ(table.size(), 12u);
  EXPECT_EQ(table[4].height, 0.15);
  EXPECT_EQ(table[4].offset, 0.05);
  EXPECT_EQ(table[4].tilt, 0.3);
  for (const FocusWidthEntry& entry : table) {
    EXPECT_GT(entry.width.sigma(), 2e-3);
    EXPECT_LT(entry.width.sigma(), 12e-3);
  }
}

TEST(FocusWidth, RejectsPositionsWithoutAFocus) {
  const PackedArray packed(usx_array(), Medium());
  EXPECT_THROW(facing(packed, Vec3(0.0, 0.0, -0.2)), std::invalid_argument);
  EXPECT_THROW(focus_width(packed, Medium(), Vec3(0.0, 0.0, 0.2), Vec3::UnitZ(), Vec3::UnitX()),
               std::invalid_argument);
}

}  // namespace
}  // namespace prostm
