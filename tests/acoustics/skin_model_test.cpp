#include "prostm/acoustics/skin/skin_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"

namespace prostm {
namespace {

using Complex = std::complex<double>;

double omega(double frequency) {
  return 2.0 * kPi * frequency;
}

TEST(SkinModel, HasTheGivenSpeedsAndLoss) {
  for (const SkinSettings& settings : skin_settings_interval()) {
    const SkinModel skin(settings);
    EXPECT_NEAR(skin.phase_speed(omega(1e-4)), settings.slow_speed, 1e-6);
    EXPECT_NEAR(skin.phase_speed(omega(1e6)), settings.fast_speed, 1e-6);
    const Complex modulus = skin.shear_modulus(omega(1.0));
    EXPECT_NEAR(modulus.imag() / modulus.real(), settings.loss, 1e-12);
    EXPECT_LT(skin.relaxation_time() * omega(1.0), 0.2);  // the relaxation lies well above 1 Hz
  }
}

// values of the nominal skin, from docs/design/skin.md
TEST(SkinModel, SpeedRisesToItsPlateau) {
  const SkinModel skin{SkinSettings{}};
  const double frequency[] = {10, 25, 50, 100, 200}, speed[] = {4.43, 5.92, 6.62, 6.89, 6.97};
  for (int i = 0; i < 5; ++i) {
    EXPECT_NEAR(skin.phase_speed(omega(frequency[i])), speed[i], 0.01);
  }
  EXPECT_NEAR(skin.relaxation_time(), 5.04e-3, 1e-5);
  EXPECT_NEAR(-skin.surface_wave_number(omega(200)).imag(), 11.5, 0.1);
  for (const SkinSettings& settings : skin_settings_interval()) {
    double before = 0.0;
    for (double f = 1.0; f < 1000.0; f *= 1.2) {
      const double now = SkinModel(settings).phase_speed(omega(f));
      EXPECT_GT(now, before);
      before = now;
    }
  }
}

TEST(SkinModel, ComplianceHasItsPoleAtTheSurfaceWave) {
  // 1/T continued to complex k vanishes at k_R. Cauchy-Riemann from the real axis is not enough for
  // that, so the Rayleigh function is written out here.
  Random random(41);
  for (int trial = 0; trial < 200; ++trial) {
    SkinSettings settings;
    settings.fast_speed = random.uniform(4.0, 12.0);
    settings.loss = random.uniform(0.05, 0.25);
    const SkinModel skin(settings);
    const double w = omega(random.uniform(5.0, 1000.0));
    const Complex k = skin.surface_wave_number(w);
    const Complex shear = settings.density * w * w / skin.shear_modulus(w);
    const Complex terms = 4.0 * k * k * k * std::sqrt(k * k - shear);
    const Complex rayleigh = (2.0 * k * k - shear) * (2.0 * k * k - shear) - terms;
    EXPECT_LT(std::abs(rayleigh), 1e-9 * std::abs(terms));
    // and (S3) is −k k_S²/(M R) on the real axis
    const double real = random.uniform(1.0, 1500.0);
    const Complex two = 2.0 * real * real - shear;
    const Complex r = two * two - 4.0 * real * real * real * std::sqrt(real * real - shear);
    const Complex expected = -real * shear / (skin.shear_modulus(w) * r);
    // R itself loses digits if k_S is small compared with k
    EXPECT_LT(std::abs(skin.compliance(real, w) - expected),
              1e-12 * std::abs(expected) * std::abs(real * real / shear + 1.0) + 1e-18);
  }
}

TEST(SkinModel, SlowPressureIndentsAsTheElasticHalfSpace) {
  const SkinModel skin{SkinSettings{}};
  const double relaxed = skin.shear_modulus(0.0).real();
  for (const double k : {10.0, 100.0, 1000.0}) {
    EXPECT_NEAR(std::abs(skin.compliance(k, 0.0)) * 2.0 * relaxed * k, 1.0, 1e-12);
    EXPECT_NEAR(std::abs(skin.compliance(k, 1e-3)) * 2.0 * relaxed * k, 1.0, 1e-4);
  }
  EXPECT_EQ(skin.compliance(0.0, omega(100)),
            Complex(0.0));  // the half-space cannot move as a whole
}

// A passive body absorbs the work of the pressure: Re(P* iωW) ≥ 0, so Im T ≤ 0 for every pattern.
TEST(SkinModel, IsPassive) {
  Random random(42);
  for (const SkinSettings& settings : skin_settings_interval()) {
    const SkinModel skin(settings);
    for (int trial = 0; trial < 500; ++trial) {
      const double k = std::exp(random.uniform(0.0, 8.0)), f = std::exp(random.uniform(0.0, 7.0));
      EXPECT_LT(skin.compliance(k, omega(f)).imag(), 0.0);
    }
  }
}

TEST(SkinModel, FreeWavesSolveTheirCubicEquation) {
  for (const SkinSettings& settings : skin_settings_interval()) {
    const SkinModel skin(settings);
    for (const double k : {5.0, 50.0, 300.0, 1500.0}) {
      const Complex s = Complex(0.0, 1.0) * skin.surface_frequency(k);
      const double tau = skin.relaxation_time();
      const double slow = k * settings.slow_speed, fast = k * settings.fast_speed;
      const Complex cubic = s * s * (1.0 + s * tau) + slow * slow + fast * fast * s * tau;
      EXPECT_LT(std::abs(cubic), 1e-12 * fast * fast * std::abs(1.0 + s * tau));
      EXPECT_GE(std::abs(s), slow * (1.0 - 1e-12));
      EXPECT_TRUE(settings.fast_speed > 9.0 || s.imag() > 0.9 * slow);
      EXPECT_LT(s.real(), 0.0);
    }
  }
  SkinSettings lossless;
  lossless.slow_speed = lossless.fast_speed;
  lossless.loss = 0.0;
  const Complex free = SkinModel(lossless).surface_frequency(100.0);
  EXPECT_NEAR(free.real(), 700.0, 1e-9);
  EXPECT_NEAR(free.imag(), 0.0, 1e-9);
}

TEST(SkinModel, SettingsAreChecked) {
  const auto refused = [](auto change) {
    SkinSettings settings;
    change(settings);
    EXPECT_THROW(SkinModel{settings}, std::invalid_argument);
  };
  refused([](auto& s) { s.slow_speed = 8.0; });
  refused([](auto& s) { s.fast_speed = std::nan(""); });
  refused([](auto& s) { s.loss = 0.0; });
  refused([](auto& s) { s.loss = 0.98; });
  refused([](auto& s) { s.fast_speed = s.slow_speed; });
  refused([](auto& s) { s.density = 0.0; });
}

}  // namespace
}  // namespace prostm
