#include "prostm/score/felt.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "prostm/acoustics/skin/skin_percept.hpp"
#include "prostm/core/units.hpp"
#include "prostm/fields/fields.hpp"

namespace prostm {
namespace {

TEST(Ghosts, AreMaximaOutsideTheTarget) {
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

/// A raster with one cell without skin, in a corner.
TargetField raster_of_skin() {
  TargetField raster = fields::make(fields::Pattern::OnePlume, 50, 32);
  std::fill(raster.skin.begin(), raster.skin.end(), std::uint8_t{1});
  raster.skin[0] = 0;
  return raster;
}

constexpr int kParts = 25;

/// Returns a spot in the middle of a raster, modulated at 200 Hz.
std::vector<double> spot_loop(const TargetField& raster, double pressure) {
  std::vector<double> loop(raster.size() * kParts, 0.0);
  for (int k = 0; k < kParts; ++k) {
    loop[static_cast<std::size_t>(k) * raster.size() + raster.index(16, 16)] =
        pressure * 0.5 * (1.0 - std::cos(2.0 * kPi * k / kParts));
  }
  return loop;
}

FeltField spot(double pressure) {
  const TargetField raster = raster_of_skin();
  return FeelingSkin(raster).feel(raster, 5e-3, kParts, spot_loop(raster, pressure));
}

TEST(FeelingSkin, FeelsASpotAtItsPositionAndIsLinear) {
  const FeltField whole = spot(100.0), half = spot(50.0);
  const auto strongest = std::max_element(whole.percept.begin(), whole.percept.end());
  EXPECT_EQ(strongest - whole.percept.begin(), 16 * 32 + 16);
  EXPECT_EQ(*strongest, whole.largest);
  EXPECT_EQ(whole.percept[0], 0.0);  // no skin
  EXPECT_GT(whole.intensity, 0.0);
  EXPECT_NEAR(half.largest / whole.largest, 0.5, 1e-9);
  EXPECT_NEAR(half.intensity / whole.intensity, 0.5, 1e-9);
}

TEST(FeltSpectrum, SharesMatchThePerceptAndTheIntensity) {
  const TargetField raster = raster_of_skin();
  // the fundamental is at 50 Hz, where area does not add; two harmonics are above
  constexpr int kLong = 100;
  std::vector<double> loop(raster.size() * kLong, 0.0);
  for (int k = 0; k < kLong; ++k) {
    double& spot = loop[static_cast<std::size_t>(k) * raster.size() + raster.index(16, 16)];
    for (const auto& [n, p] : {std::pair{1, 300.0}, {4, 50.0}, {6, 20.0}}) {
      spot += p * std::cos(2.0 * kPi * n * k / kLong);
    }
  }
  FeelingSkin skin(raster);
  const FeltField felt = skin.feel(raster, 20e-3, kLong, loop);
  const std::vector<FeltHarmonic> spectrum = felt_spectrum(raster, skin.motion());
  ASSERT_EQ(spectrum.size(), 20u);
  double at_strongest = 0.0, intensity = 0.0;
  for (const FeltHarmonic& h : spectrum) {
    at_strongest += h.share_at_strongest;
    intensity += h.share_of_intensity;
    EXPECT_NEAR(h.velocity_strongest, 2.0 * kPi * h.frequency * h.displacement_strongest, 1e-12);
    EXPECT_LE(h.displacement_skin, h.displacement_strongest);
  }
  EXPECT_NEAR(at_strongest, 1.0, 1e-12);
  EXPECT_NEAR(intensity, 1.0, 1e-12);
  for (const std::size_t n : {1u, 4u, 6u}) {
    const FeltHarmonic& h = spectrum[n - 1];
    EXPECT_NEAR(h.frequency, 50.0 * static_cast<double>(n), 1e-9);
    const double s = pacinian_sensitivity(h.frequency);
    EXPECT_NEAR(s * h.displacement_strongest / felt.largest, std::sqrt(h.share_at_strongest), 1e-9);
    EXPECT_GT(h.share_of_intensity, 0.001);
  }
  EXPECT_LT(spectrum[1].share_at_strongest, 1e-12);
  // at 50 Hz the intensity is that of the strongest position, which is this one
  const double expected =
      spectrum[0].share_at_strongest * std::pow(felt.largest / felt.intensity, 2);
  EXPECT_NEAR(spectrum[0].share_of_intensity / expected, 1.0, 1e-9);
}

TEST(FeelingBoundedSkin, FeelsASpotAsTheHalfSpaceDoesAtItsPositionAndDiffersElsewhere) {
  const TargetField raster = raster_of_skin();
  FeelingBoundedSkin skin(raster);
  const FeltField first = skin.feel(raster, 5e-3, kParts, spot_loop(raster, 100.0));
  const FeltField again = skin.feel(raster, 5e-3, kParts, spot_loop(raster, 100.0));
  EXPECT_EQ(first.percept, again.percept);
  const FeltField half_space = spot(100.0);
  const std::size_t middle = raster.index(16, 16);
  EXPECT_EQ(first.percept[middle], first.largest);
  EXPECT_NEAR(first.largest / half_space.largest, 1.0, 0.25);
  EXPECT_EQ(first.percept[0], 0.0);  // no skin
  double difference = 0.0;
  for (std::size_t c = 0; c < raster.size(); ++c) {
    difference = std::max(difference, std::abs(first.percept[c] - half_space.percept[c]));
  }
  EXPECT_GT(difference, 0.02 * half_space.largest);  // reflected waves
  SkinSettings slow;
  slow.fast_speed = 5.0;
  const FeltField other =
      FeelingBoundedSkin(raster, slow).feel(raster, 5e-3, kParts, spot_loop(raster, 100.0));
  EXPECT_GT(other.largest, 1.2 * first.largest);  // softer skin
}

TEST(FeelingSkin, ReportsWhichLoopsAreFelt) {
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
