#include "prostm/acoustics/skin/sensation_level.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace prostm {
namespace {

double decibels(double ratio) {
  return 20.0 * std::log10(ratio);
}

TEST(SensationLevel, IsZeroAtTheThreshold) {
  EXPECT_NEAR(sensation_level(kTouchThreshold, autd3_array()), 0.0, 1e-12);
  EXPECT_NEAR(sensation_level(10.0 * kTouchThreshold, autd3_array()), 20.0, 1e-12);
  EXPECT_NEAR(sensation_level(kTouchThreshold), 0.0, 1e-12);
}

TEST(SensationLevel, CountsRadiationPressureAtTheMeasuredAmplitude) {
  TransducerArray array = usx_array();
  EXPECT_NEAR(measured_share(array), 0.104, 0.001);
  EXPECT_NEAR(sensation_level(kTouchThreshold, array), -19.66, 0.01);
  array.measured_amplitude = 2.0 * array.amplitude;
  EXPECT_NEAR(sensation_level(kTouchThreshold, array), decibels(4.0), 1e-9);
}

TEST(SensationLevel, IsUnknownWithoutVibration) {
  EXPECT_TRUE(std::isnan(sensation_level(0.0, usx_array())));
  EXPECT_TRUE(std::isnan(sensation_level(std::nan(""), usx_array())));
  EXPECT_TRUE(std::isnan(sensation_level(0.0)));
}

TEST(SensationLevel, TheMeasuredAmplitudeGivesTheMeasuredSoundLevel) {
  TransducerArray array = usx_array();
  array.amplitude = array.measured_amplitude;
  const double sound = focus_pressure(array, Medium{}, Vec3(0.0, 0.0, 0.2));
  EXPECT_NEAR(decibels(sound / 20e-6), 155.0, 1e-6);
}

TEST(SensationInterval, CombinesPeopleThresholdAndArray) {
  const SensationInterval measured = sensation_interval(usx_array());
  EXPECT_NEAR(measured.below, std::hypot(3.0, 1.96 * kThresholdSpread, 4.0), 1e-12);
  EXPECT_EQ(measured.above, measured.below);
  EXPECT_EQ(measured.sound, SoundSource::Measured);
  EXPECT_NEAR(sensation_interval().below, std::hypot(3.0, 1.96 * kThresholdSpread), 1e-12);
  EXPECT_EQ(sensation_interval().sound, SoundSource::Given);

  TransducerArray nominal = usx_array();
  nominal.measured_amplitude = 0.0;
  const SensationInterval wide = sensation_interval(nominal);
  EXPECT_NEAR(wide.above, std::hypot(3.0, 1.96 * kThresholdSpread, 2.0 * decibels(8.0 / 3.4)),
              1e-9);
  EXPECT_NEAR(wide.below, std::hypot(3.0, 1.96 * kThresholdSpread, 2.0 * decibels(3.4 / 2.5)),
              1e-9);
  EXPECT_EQ(wide.sound, SoundSource::Nominal);
  const SensationInterval exact = sensation_interval(autd3_array());
  EXPECT_NEAR(exact.below, std::hypot(3.0, 1.96 * kThresholdSpread), 1e-12);
  EXPECT_EQ(exact.above, exact.below);
}

TEST(SensationWords, StateWhoFeelsIt) {
  const SensationInterval interval = sensation_interval(usx_array());
  EXPECT_EQ(sensation_words(3.2, interval),
            "about 3 dB above the threshold of touch (-6 to 12 dB): most people feel it, some may "
            "not");
  EXPECT_EQ(sensation_words(-4.0, interval),
            "about 4 dB below the threshold of touch (-13 to 5 dB): most people do not feel it, "
            "some may");
  EXPECT_EQ(sensation_words(-12.0, interval),
            "about 12 dB below the threshold of touch (-21 to -3 dB): hardly anyone feels it");
  EXPECT_EQ(sensation_words(12.0, interval),
            "about 12 dB above the threshold of touch (3 to 21 dB): nearly everyone feels it");
}

}  // namespace
}  // namespace prostm
