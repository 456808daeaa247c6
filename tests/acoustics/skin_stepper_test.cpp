#include "prostm/acoustics/skin/skin_stepper.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <stdexcept>
#include <vector>

#include "prostm/core/units.hpp"

namespace prostm {
namespace {

using Complex = std::complex<double>;

/// Returns W/P of the stepper under P = cos(ωt) [m/Pa], over the last period before
/// 0.15 s + 2.5 m⁻¹ s/k.
Complex stepped_compliance(const SkinModel& skin, double k, double frequency, double longest) {
  const int per_period = static_cast<int>(std::ceil(1.0 / (frequency * longest)));
  const double step = 1.0 / (frequency * per_period);
  const int periods = static_cast<int>(std::ceil((0.15 + 2.5 / k) * frequency));
  SkinStepper stepper(skin, k, step);
  Complex sum = 0.0;
  for (int n = 0; n < periods * per_period; ++n) {
    const double phase = 2.0 * kPi * (n % per_period) / per_period;
    if (n >= (periods - 1) * per_period) {
      sum += stepper.displacement() * std::polar(2.0 / per_period, -phase);
    }
    // rises slowly, so that hardly any other frequency is excited
    const double rise = std::min(1.0, n * step / 0.03);
    stepper.step(std::cos(phase) * rise * rise * (3.0 - 2.0 * rise));
  }
  return sum;
}

TEST(SkinStepper, SettlesToTheClosedForm) {
  for (const SkinSettings& settings :
       {SkinSettings{}, skin_settings_interval()[0], skin_settings_interval()[8]}) {
    const SkinModel skin(settings);
    for (const double k : {20.0, 80.0, 300.0, 800.0}) {
      for (const double f : {40.0, 120.0, 400.0}) {
        const Complex exact = skin.compliance(k, 2.0 * kPi * f);
        const Complex found =
            stepped_compliance(skin, k, f, std::min(2e-5, 0.05 / (k * skin.settings().fast_speed)));
        EXPECT_LT(std::abs(found - exact), 1e-3 * std::abs(exact))
            << k << " rad/m, " << f << " Hz: " << std::abs(found / exact) << " "
            << std::arg(found / exact);
      }
    }
  }
}

/// Returns the slope of the least-squares line.
double fitted_slope(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sx += x[i];
    sy += y[i];
    sxx += x[i] * x[i];
    sxy += x[i] * y[i];
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

// A pattern that is excited and then released rings as the surface wave of its wave number: its
// energy falls as e^{−2 Im Ω t} and it oscillates with Re Ω, (S5).
TEST(SkinStepper, EnergyDecaysWithTheGivenDamping) {
  for (const SkinSettings& settings : {SkinSettings{}, skin_settings_interval()[8]}) {
    const SkinModel skin(settings);
    const double k = 250.0, step = 1e-5;
    const Complex wave = skin.surface_frequency(k);
    SkinStepper stepper(skin, k, step);
    // fifteen periods at Ω excite it; after fifteen more the shear waves have left
    const double period = 2.0 * kPi / wave.real();
    const auto count = [&](double periods) { return static_cast<int>(periods * period / step); };
    std::vector<double> times, logs, crossings, course;
    for (int n = 0; n < count(40.0); ++n) {
      stepper.step(n < count(15.0) ? std::sin(wave.real() * n * step) : 0.0);
      course.push_back(stepper.displacement());
    }
    // the tissue also creeps back slowly, so the acceleration is evaluated
    const auto acceleration = [&](int n) {
      const auto i = static_cast<std::size_t>(n);
      return course[i + 1] - 2.0 * course[i] + course[i - 1];
    };
    for (int n = count(30.0); n + 1 < count(40.0); ++n) {
      const double before = acceleration(n - 1), now = acceleration(n);
      if ((now > 0.0) != (before > 0.0)) crossings.push_back((n - now / (now - before)) * step);
      // for a decaying oscillation y, without ripple: y² + (y' + Im Ω y)²/(Re Ω)²
      const double middle = 0.5 * (now + before);
      const double quadrature = ((now - before) / step + wave.imag() * middle) / wave.real();
      times.push_back(n * step);
      logs.push_back(std::log(middle * middle + quadrature * quadrature));
    }
    const double slope = fitted_slope(times, logs);
    EXPECT_NEAR(slope / (-2.0 * wave.imag()), 1.0, 0.02);
    ASSERT_GT(crossings.size(), 10u);
    const double half =
        (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
    EXPECT_NEAR(kPi / half / wave.real(), 1.0, 0.02);
  }
}

TEST(SkinStepper, SettingsAreChecked) {
  const SkinModel skin{SkinSettings{}};
  EXPECT_THROW(SkinStepper(skin, 0.0, 1e-5), std::invalid_argument);
  EXPECT_THROW(SkinStepper(skin, 100.0, 0.0), std::invalid_argument);
  EXPECT_THROW(SkinStepper(skin, 2000.0, 2e-5), std::invalid_argument);
  EXPECT_THROW(SkinStepper(skin, 10.0, 2e-4), std::invalid_argument);
}

}  // namespace
}  // namespace prostm
