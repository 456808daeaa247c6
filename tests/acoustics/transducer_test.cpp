#include "prostm/acoustics/array/transducer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "prostm/acoustics/array/array.hpp"
#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"
#include "support/heap_guard.hpp"

namespace prostm {
namespace {

using Complex = std::complex<double>;

/// Returns the output of one transducer after a constant drive of n samples.
Complex held(TransducerDynamics& one, Complex drive, int n) {
  for (int i = 0; i < n; ++i) one.step(std::span(&drive, 1));
  return one.output()[0];
}

// a(t) = q (1 − e^{−t/τ}) up to the last sample, at any sampling rate.
TEST(Transducer, StepResponseIsTheExponential) {
  for (const double rate : {20e3, 40e3, 160e3}) {
    TransducerSettings settings;
    settings.sample_rate = rate;
    const double tau = time_constant(settings);
    EXPECT_NEAR(tau, 0.2276e-3, 1e-7);
    TransducerDynamics one(settings, 1);
    for (int n = 1; n <= 100; ++n) {
      const Complex expected = std::polar(0.7, 1.2) * (1.0 - std::exp(-n / rate / tau));
      EXPECT_LT(std::abs(held(one, std::polar(0.7, 1.2), 1) - expected), 1e-13);
    }
    const Complex start = one.output()[0];
    for (int n = 1; n <= 100; ++n) {
      EXPECT_LT(std::abs(held(one, 0.0, 1) - start * std::exp(-n / rate / tau)), 1e-13);
    }
  }
}

// If a drive e^{iωnT} is held over each sample, the output at the sample's end is
// e^{iωnT} (1 − d)/(1 − d e^{−iωT}), d = e^{−T/τ}; without holding it would be 1/(1 + iωτ).
TEST(Transducer, SteadyModulationHasItsClosedForm) {
  TransducerSettings settings;
  settings.sample_rate = 400e3;
  const double tau = time_constant(settings), step = 1.0 / settings.sample_rate;
  for (const double hertz : {-5000.0, -699.3, 50.0, 200.0, 699.3, 3000.0}) {
    const double omega = 2.0 * kPi * hertz, decay = std::exp(-step / tau);
    TransducerDynamics one(settings, 1);
    Complex drive;
    for (int n = 0; n < 4000; ++n) {
      drive = std::polar(1.0, omega * n * step);
      one.step(std::span(&drive, 1));
    }
    const Complex gain = one.output()[0] / drive;
    const Complex held_gain = (1.0 - decay) / (1.0 - decay * std::polar(1.0, -omega * step));
    EXPECT_LT(std::abs(gain - held_gain), 1e-9) << hertz;
    EXPECT_NEAR(std::abs(gain), 1.0 / std::abs(Complex(1.0, omega * tau)), 0.002) << hertz;
  }
}

// Half the power at a detuning of f/(2Q).
TEST(Transducer, HalfBandwidthIsFOver2Q) {
  TransducerSettings settings;
  settings.detuning = settings.frequency / (2.0 * settings.quality);
  EXPECT_NEAR(settings.detuning, 699.3, 0.05);
  TransducerDynamics one(settings, 1);
  const Complex output = held(one, 1.0, 500);
  EXPECT_NEAR(std::abs(output), std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(std::arg(output), -0.25 * kPi, 1e-12);
  // undriven it rings at its own frequency: the phase advances by −2πδ per second, as in e^{−iωt}
  const Complex next = held(one, 0.0, 1);
  EXPECT_NEAR(std::arg(next / output), -2.0 * kPi * settings.detuning / settings.sample_rate,
              1e-12);
}

TEST(Transducer, IsLinearAndActsOnEachTransducerAlone) {
  Random random(31);
  const auto any = [&] { return Complex(random.normal(), random.normal()); };
  TransducerSettings settings;
  settings.detuning = -300.0;
  for (int trial = 0; trial < 50; ++trial) {
    const Complex u = any(), v = any();
    TransducerDynamics all(settings, 3);
    for (int n = 0; n < 100; ++n) {
      const Complex a = any(), b = any();
      all.step(std::vector<Complex>{a, b, u * a + v * b});
      const auto out = all.output();
      EXPECT_LT(std::abs(out[2] - u * out[0] - v * out[1]), 1e-12 * (1.0 + std::abs(out[2])));
    }
  }
}

TEST(Transducer, WithoutMemoryTheOutputEqualsTheDrive) {
  Random random(32);
  TransducerSettings settings;
  settings.memoryless = true;
  TransducerDynamics all(settings, 2);
  for (int n = 0; n < 100; ++n) {
    const std::vector<Complex> drives{{random.normal(), 0.5}, {0.0, random.normal()}};
    all.step(drives);
    EXPECT_EQ(all.output()[0], drives[0]);
    EXPECT_EQ(all.output()[1], drives[1]);
  }
}

TEST(Transducer, DecaysToSilenceAndIsSilentAfterReset) {
  TransducerDynamics one({}, 1);
  held(one, 1.0, 100);
  EXPECT_EQ(held(one, 0.0, 2000), Complex(0.0));
  held(one, 1.0, 100);
  one.reset();
  EXPECT_EQ(one.output()[0], Complex(0.0));
}

TEST(Transducer, AStepDoesNotAllocate) {
  TransducerDynamics all({}, 256);
  const std::vector<Complex> drives(256, Complex(0.3, 0.4));
  const test::HeapGuard guard;
  for (int n = 0; n < 100; ++n) all.step(drives);
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(Transducer, SettingsAreChecked) {
  const auto refused = [](auto change) {
    TransducerSettings settings;
    change(settings);
    EXPECT_THROW(TransducerDynamics(settings, 1), std::invalid_argument);
  };
  refused([](auto& s) { s.frequency = 0.0; });
  refused([](auto& s) { s.quality = 0.1; });
  refused([](auto& s) { s.detuning = 5e3; });
  refused([](auto& s) { s.sample_rate = 0.0; });
}

/// Lag and strength of the field of a focus that passes the origin along x at speed v.
struct Moving {
  double lag, share;  ///< [m] behind the commanded position; relative to a focus at rest
};
Moving moving_focus(double v) {
  const TransducerArray array = usx_array();
  const Medium air;
  const Wave sound = wave(array, air);
  const std::size_t count = array.position.size();
  const TransducerSettings settings;
  TransducerDynamics dynamics(settings, count);
  std::vector<double> phases(count);
  std::vector<Complex> drives(count);
  constexpr int kSamples = 200;
  for (int n = 1; n <= kSamples; ++n) {
    // the middle of each sample, so that x = 0 is commanded at the end of the last one
    const double x = v * (n - 0.5 - kSamples) / settings.sample_rate;
    focus_phases(array, air, Vec3(x, 0.0, 0.2), phases);
    for (std::size_t i = 0; i < count; ++i) drives[i] = std::polar(1.0, phases[i]);
    dynamics.step(drives);
  }
  double rest = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    rest += std::abs(propagate(array, sound, i, Vec3(0.0, 0.0, 0.2)));
  }
  Moving found{0.0, 0.0};
  for (double lag = 0.0; lag < 6e-3; lag += 0.02e-3) {
    Complex sum = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      sum += dynamics.output()[i] * propagate(array, sound, i, Vec3(-lag, 0.0, 0.2));
    }
    if (std::abs(sum) / rest > found.share) found = {lag, std::abs(sum) / rest};
  }
  return found;
}

TEST(Transducer, AFastFocalPointLagsAndIsWeaker) {
  const Moving slow = moving_focus(0.5), usual = moving_focus(7.0), fast = moving_focus(14.0);
  EXPECT_NEAR(slow.lag, 0.5 * time_constant({}), 0.03e-3);  // lag v τ at low speed
  EXPECT_NEAR(slow.share, 1.0, 1e-3);
  EXPECT_NEAR(usual.lag, 1.54e-3, 0.05e-3);
  EXPECT_NEAR(usual.share, 0.971, 0.002);
  EXPECT_NEAR(fast.lag, 2.82e-3, 0.05e-3);
  EXPECT_NEAR(fast.share, 0.903, 0.003);
}

}  // namespace
}  // namespace prostm
