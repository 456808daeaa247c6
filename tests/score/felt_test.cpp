#include "prostm/score/felt.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fields/fields.hpp"
#include "prostm/core/units.hpp"

namespace prostm {
namespace {

TEST(Ghosts, AreMaximaWhereNothingIsToBeFelt) {
  TargetField field = fields::make(fields::Pattern::OnePlume, 50, 32);
  std::fill(field.skin.begin(), field.skin.end(), std::uint8_t{1});
  std::fill(field.pressure.begin(), field.pressure.end(), 0.0);
  field.pressure[field.index(8, 8)] = 1.0;
  std::vector<double> felt(field.size(), 0.0);
  EXPECT_EQ(ghosts_of(field, {std::vector<double>(field.size(), 1.0)}).largest, 1.0);
  felt[field.index(8, 8)] = 1.0;
  EXPECT_EQ(ghosts_of(field, felt).count, 0);
  EXPECT_EQ(ghosts_of(field, felt).largest, 0.0);
  felt[field.index(8, 9)] = 0.9;  // 5 mm away, but not a maximum
  felt[field.index(9, 9)] = 0.9;
  EXPECT_EQ(ghosts_of(field, felt).largest, 0.0);
  felt[field.index(24, 24)] = 0.6;
  felt[field.index(24, 8)] = 0.4;
  EXPECT_EQ(ghosts_of(field, felt).count, 1);
  EXPECT_EQ(ghosts_of(field, felt).largest, 0.6);
  field.skin[field.index(24, 24)] = 0;
  EXPECT_EQ(ghosts_of(field, felt).count, 0);
  EXPECT_EQ(ghosts_of(field, felt).largest, 0.4);
}

/// Returns the percept of a spot in the middle of a raster of skin, modulated at 200 Hz.
FeltField spot(double pressure) {
  TargetField raster = fields::make(fields::Pattern::OnePlume, 50, 32);
  raster.skin[0] = 0;
  constexpr int kParts = 25;
  std::vector<double> loop(raster.size() * kParts, 0.0);
  for (int k = 0; k < kParts; ++k) {
    loop[static_cast<std::size_t>(k) * raster.size() + raster.index(16, 16)] =
        pressure * 0.5 * (1.0 - std::cos(2.0 * kPi * k / kParts));
  }
  return FeelingSkin(raster).feel(raster, 5e-3, kParts, loop);
}

TEST(FeelingSkin, FeelsASpotWhereItIsAndHalfOfHalf) {
  const FeltField whole = spot(100.0), half = spot(50.0);
  const auto strongest = std::max_element(whole.percept.begin(), whole.percept.end());
  EXPECT_EQ(strongest - whole.percept.begin(), 16 * 32 + 16);
  EXPECT_EQ(*strongest, whole.largest);
  EXPECT_EQ(whole.percept[0], 0.0);  // no skin
  EXPECT_GT(whole.intensity, 0.0);
  EXPECT_NEAR(half.largest / whole.largest, 0.5, 1e-9);
  EXPECT_NEAR(half.intensity / whole.intensity, 0.5, 1e-9);
}

TEST(FeelingSkin, SaysWhichLoopsAreFelt) {
  const TargetField raster = fields::make(fields::Pattern::OnePlume, 50, 32);
  LoopSamples loop;
  loop.sample_rate = 40e3;
  loop.samples = 800;
  EXPECT_TRUE(is_felt(raster, loop));
  loop.samples = 10'000;
  EXPECT_TRUE(is_felt(raster, loop));
  loop.samples = 10'008;
  EXPECT_FALSE(is_felt(raster, loop));
  loop.samples = 16;
  EXPECT_FALSE(is_felt(raster, loop));
  loop.samples = 800;
  EXPECT_FALSE(is_felt(fields::make(fields::Pattern::OnePlume, 50, 129), loop));
}

}  // namespace
}  // namespace prostm
