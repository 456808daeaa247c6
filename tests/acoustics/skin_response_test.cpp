#include "prostm/acoustics/skin/skin_response.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "acoustics/skin_loops.hpp"
#include "prostm/acoustics/skin/skin_stepper.hpp"
#include "prostm/core/random.hpp"
#include "support/heap_guard.hpp"

namespace prostm {
namespace {

using Complex = std::complex<double>;

/// Computes the displacement [m] at a cell and a time from its harmonics.
double displacement_at(const SkinResponse& response, int cell, double time) {
  double sum = 0.0;
  for (int n = 1; n <= response.harmonics(); ++n) {
    const Complex turn = std::polar(1.0, 2.0 * kPi * response.frequency(n) * time);
    sum += (response.displacement(n)[static_cast<std::size_t>(cell)] * turn).real();
  }
  return sum;
}

// The same focus in time, without harmonics: w(x, t) = (2π)⁻² ∫∫ w_k(t) e^{ikx} d²k, where the
// focus presses on the pattern e^{−ikx} with e^{−k²σ²/2 − ik x_f(t)}. Turning k by an angle equals
// waiting until the focus has circled by that angle, so one direction is stepped per |k|.
class SteppedFocus {
 public:
  SteppedFocus(const SkinModel& skin, const test::CirclingFocus& focus, int angles)
      : focus_(focus), angles_(angles) {
    const double speed = skin.settings().fast_speed;
    for (double k = kStep; k * focus.sigma < 4.2; k += kStep) {
      const int every =
          static_cast<int>(std::ceil(focus.period / (angles * std::min(2e-5, 0.07 / (k * speed)))));
      course_.push_back(lap(skin, k, angles, every));
    }
  }
  /// Returns the displacement without its mean over a lap. @param moment integer multiple of
  /// period/angles
  double displacement(const Vec2& x, int moment) const {
    double sum = 0.0;
    for (std::size_t m = 0; m < course_.size(); ++m) {
      const double k = kStep * static_cast<double>(m + 1);
      Complex around = 0.0;
      for (int a = 0; a < angles_; ++a) {
        const double angle = 2.0 * kPi * a / angles_;
        const Vec2 direction(std::cos(angle), std::sin(angle));
        const auto when = static_cast<std::size_t>((moment - a + 2 * angles_) % angles_);
        around += course_[m][when] * std::polar(1.0, k * direction.dot(x));
      }
      sum += around.real() / angles_ * k * kStep / (2.0 * kPi);
    }
    return sum;
  }

 private:
  static constexpr double kStep = 8.0;  // [rad/m]: a copy of the focus every 0.79 m

  /// Returns w_k over one lap in the steady state, for k along x, without its mean.
  std::vector<Complex> lap(const SkinModel& skin, double k, int angles, int every) const {
    const double step = focus_.period / (angles * every);
    SkinStepper real(skin, k, step), imaginary(skin, k, step);
    const int laps = static_cast<int>(std::ceil(0.13 / focus_.period));
    std::vector<Complex> course;
    Complex mean = 0.0;
    for (int n = 0; n < laps * angles * every; ++n) {
      if (n % every == 0 && n >= (laps - 1) * angles * every) {
        course.emplace_back(real.displacement(), imaginary.displacement());
        mean += course.back() / static_cast<double>(angles);
      }
      const Complex load = std::polar(std::exp(-0.5 * k * k * focus_.sigma * focus_.sigma),
                                      -k * focus_.at(n * step).x());
      real.step(load.real());
      imaginary.step(load.imag());
    }
    for (Complex& value : course) value -= mean;
    return course;
  }

  test::CirclingFocus focus_;
  int angles_;
  std::vector<std::vector<Complex>> course_;
};

TEST(SkinResponse, MatchesTimeStepping) {
  const SkinModel skin{SkinSettings{}};
  test::CirclingFocus focus;
  focus.sigma = 6e-3;
  const SkinPatch patch{33, 33, 2e-3};
  const SkinResponse response = test::response_to(focus, skin, patch, 64, 3000.0);
  const int angles = 64;
  const SteppedFocus stepped(skin, focus, angles);
  double largest = 0.0, difference = 0.0;
  for (const auto& [row, col] : {std::pair{16, 16}, {16, 21}, {21, 16}, {10, 12}, {2, 30}}) {
    for (int moment = 0; moment < angles; moment += 8) {
      const double expected = stepped.displacement(test::cell_centre(patch, row, col), moment);
      const double found =
          displacement_at(response, row * patch.cols + col, moment * focus.period / angles);
      largest = std::max(largest, std::abs(expected));
      difference = std::max(difference, std::abs(found - expected));
    }
  }
  RecordProperty("relative difference", std::to_string(difference / largest));
  EXPECT_LT(difference, 1e-3 * largest) << difference / largest;
}

/// Returns a focus at rest with pressure F (1 + cos ωt)/2, F = 1 N: harmonic 1 is the response.
std::vector<double> modulated_focus(const SkinPatch& patch, int row, int col, double sigma,
                                    int samples) {
  std::vector<double> pressure;
  const Vec2 middle = test::cell_centre(patch, row, col);
  for (int k = 0; k < samples; ++k) {
    const double share = 0.5 + 0.5 * std::cos(2.0 * kPi * k / samples);
    for (int j = 0; j < patch.rows; ++j) {
      for (int i = 0; i < patch.cols; ++i) {
        const double square = (test::cell_centre(patch, j, i) - middle).squaredNorm();
        pressure.push_back(share * std::exp(-0.5 * square / (sigma * sigma)) /
                           (2.0 * kPi * sigma * sigma));
      }
    }
  }
  return pressure;
}

// Far from an amplitude-modulated focus at rest, the phase advances with Re k_R and the amplitude
// falls as e^{−αr}/√r: the surface wave.
TEST(SkinResponse, APointSourceEmitsTheSurfaceWave) {
  for (const SkinSettings& settings : skin_settings_interval()) {
    const SkinModel skin(settings);
    const double frequency = 80.0 * settings.fast_speed, omega = 2.0 * kPi * frequency;
    const SkinPatch patch{9, 90, 2e-3};  // 14 wavelengths long
    SkinResponse response(skin, patch);
    response.prepare(1.0 / frequency, 4, frequency);
    const std::vector<double> pressure = modulated_focus(patch, 4, 6, 2.5e-3, 4);
    response.respond({1.0 / frequency, 4, pressure});
    const auto at = [&](int cells) {
      return response.displacement(1)[static_cast<std::size_t>(4 * patch.cols + 6 + cells)];
    };
    // 4 to 10 wavelengths away, phase differences between cells
    double phase = 0.0;
    for (int r = 25; r < 65; ++r) phase -= std::arg(at(r + 1) / at(r));
    const double path = 40 * patch.cell;
    const std::complex<double> k = skin.surface_wave_number(omega);
    EXPECT_NEAR(phase / (k.real() * path), 1.0, 0.02);
    const double fall = std::log(std::abs(at(25)) / std::abs(at(65)) * std::sqrt(25.0 / 65.0));
    const double expected = -k.imag() * path;
    EXPECT_NEAR(fall, expected, std::max(0.04, 0.05 * expected))
        << settings.fast_speed << " " << settings.loss;
  }
}

TEST(SkinResponse, HalfThePressureGivesHalfTheResponse) {
  const SkinModel skin{SkinSettings{}};
  const SkinPatch patch{12, 17, 2e-3};
  SkinResponse response(skin, patch);
  response.prepare(20e-3, 32);
  Random random(43);
  std::vector<double> pressure(12 * 17 * 32);
  for (double& p : pressure) p = random.uniform();
  response.respond({20e-3, 32, pressure});
  std::vector<Complex> whole;
  for (int n = 1; n <= response.harmonics(); ++n) {
    for (const Complex& w : response.displacement(n)) whole.push_back(w);
  }
  for (double& p : pressure) p *= 0.5;
  response.respond({20e-3, 32, pressure});
  std::size_t next = 0;
  for (int n = 1; n <= response.harmonics(); ++n) {
    for (const Complex& w : response.displacement(n)) EXPECT_EQ(w, 0.5 * whole[next++]);
  }
}

TEST(SkinResponse, IsReciprocal) {
  const SkinModel skin{SkinSettings{}};
  const SkinPatch patch{15, 22, 2e-3};
  SkinResponse response(skin, patch);
  response.prepare(5e-3, 8);
  Random random(44);
  for (int trial = 0; trial < 20; ++trial) {
    const int row = random.below(15), col = random.below(22);
    const int other_row = random.below(15), other_col = random.below(22);
    const auto heard = [&](int from_row, int from_col, int at_row, int at_col) {
      const std::vector<double> pressure = modulated_focus(patch, from_row, from_col, 0.2e-3, 8);
      response.respond({5e-3, 8, pressure});
      return response.displacement(1)[static_cast<std::size_t>(at_row * patch.cols + at_col)];
    };
    const Complex there = heard(row, col, other_row, other_col);
    const Complex back = heard(other_row, other_col, row, col);
    EXPECT_LT(std::abs(there - back), 1e-10 * std::abs(there));
  }
}

// Skin continues around the patch: the response does not depend on the patch's size.
TEST(SkinResponse, TheEdgeOfThePatchReflectsNothing) {
  const SkinModel skin{SkinSettings{}};
  test::CirclingFocus focus;
  focus.radius = 8e-3;
  focus.sigma = 2.5e-3;
  const SkinPatch small{31, 31, 2e-3}, wide{91, 71, 2e-3};
  const SkinResponse seen = test::response_to(focus, skin, small, 32);
  const SkinResponse all = test::response_to(focus, skin, wide, 32);
  double largest = 0.0, difference = 0.0;
  for (int n = 1; n <= seen.harmonics(); ++n) {
    for (int j = 0; j < small.rows; ++j) {
      for (int i = 0; i < small.cols; ++i) {
        const Complex here = seen.displacement(n)[static_cast<std::size_t>(j * small.cols + i)];
        const Complex there =
            all.displacement(n)[static_cast<std::size_t>((j + 30) * wide.cols + i + 20)];
        largest = std::max(largest, std::abs(there));
        difference = std::max(difference, std::abs(here - there));
      }
    }
  }
  EXPECT_LT(difference, 1e-6 * largest);
}

TEST(SkinResponse, ConvergesWithTheCellSize) {
  const SkinModel skin{SkinSettings{}};
  const test::CirclingFocus focus;
  const auto amplitudes = [&](double cell) {  // at two positions 24 mm apart
    const int half = static_cast<int>(std::lround(24e-3 / cell));
    const SkinPatch patch{2 * half + 1, 2 * half + 1, cell};
    const SkinResponse response = test::response_to(focus, skin, patch, 32, 500.0);
    std::vector<Complex> found;
    for (int n = 1; n <= response.harmonics(); ++n) {
      for (const int col : {half, 2 * half}) {
        found.push_back(
            response.displacement(n)[static_cast<std::size_t>(half * patch.cols + col)]);
      }
    }
    return found;
  };
  const std::vector<Complex> fine = amplitudes(1e-3);
  const auto error = [&](double cell) {
    const std::vector<Complex> coarse = amplitudes(cell);
    double worst = 0.0, largest = 0.0;
    for (std::size_t i = 0; i < fine.size(); ++i) {
      worst = std::max(worst, std::abs(coarse[i] - fine[i]));
      largest = std::max(largest, std::abs(fine[i]));
    }
    return worst / largest;
  };
  // cells of 2 and 3 mm resolve σ = 4 mm, cells of 6 mm do not
  EXPECT_LT(error(2e-3), 1e-3);
  EXPECT_LT(error(3e-3), 1e-2);
  EXPECT_GT(error(6e-3), error(3e-3));
}

// (S9) and (S11) without tables and transforms: pressure on one cell, response of other cells.
TEST(SkinResponse, MatchesTheSumOverWaveNumbers) {
  Random random(11);
  const SkinModel skin{SkinSettings{}};
  int next = 20;
  for (const double cell : {0.35e-3, 1e-3, 3e-3}) {
    const SkinPatch patch{23, 40, cell};
    const int samples = next++, cells = patch.rows * patch.cols;
    SkinResponse response(skin, patch);
    response.prepare(9e-3, samples);
    const int pressed = random.below(cells);
    std::vector<double> pressure(static_cast<std::size_t>(samples * cells), 0.0);
    for (int k = 0; k < samples; ++k)
      pressure[static_cast<std::size_t>(k * cells + pressed)] = random.uniform(0.0, 100.0);
    response.respond({9e-3, samples, pressure});
    for (int trial = 0; trial < 20; ++trial) {
      const int n = 1 + random.below(response.harmonics());
      const int felt = trial == 0 ? pressed : random.below(cells);
      const auto displacement = [&](int at) {
        const double r = cell * std::hypot(at / patch.cols - pressed / patch.cols,
                                           at % patch.cols - pressed % patch.cols);
        Complex loop = 0.0, sum = 0.0;
        for (int k = 0; k < samples; ++k) {
          loop += 2.0 / samples * std::polar(1.0, -2.0 * kPi * n * k / samples) *
                  pressure[static_cast<std::size_t>(k * cells + pressed)];
        }
        for (double k = 1.0; k < kPi / cell + 1.0; k += 1.0)
          sum += skin.compliance(k, 2.0 * kPi * response.frequency(n)) * j0(k * r) * k;
        return loop * sum * cell * cell / (2.0 * kPi);
      };
      const Complex found = response.displacement(n)[static_cast<std::size_t>(felt)];
      EXPECT_LT(std::abs(found - displacement(felt)), 1e-10 * std::abs(displacement(pressed)));
    }
  }
}

TEST(SkinResponse, RespondDoesNotAllocate) {
  const SkinPatch patch{20, 30, 2e-3};
  SkinResponse response(SkinModel{SkinSettings{}}, patch);
  response.prepare(20e-3, 40);
  const std::vector<double> pressure(20 * 30 * 40, 1.0);
  std::vector<double> map(20 * 30);
  const test::HeapGuard guard;
  response.respond({20e-3, 40, pressure});
  rms_velocity(response, map);
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(SkinResponse, MapsAndSpectraFollowFromTheHarmonics) {
  const SkinModel skin{SkinSettings{}};
  const test::CirclingFocus focus;
  const SkinPatch patch{21, 21, 2e-3};
  const SkinResponse response = test::response_to(focus, skin, patch, 32);
  ASSERT_EQ(response.harmonics(), 10);  // 100 Hz to 1 kHz
  std::vector<double> map(21 * 21), spectrum(10);
  rms_velocity(response, map);
  for (const int cell : {0, 100, 220, 440}) {
    // over a lap, by finite differences in time
    double squares = 0.0;
    const int steps = 4000;
    for (int k = 0; k < steps; ++k) {
      const double t = k * focus.period / steps, dt = focus.period / steps;
      const double velocity =
          (displacement_at(response, cell, t + dt) - displacement_at(response, cell, t)) / dt;
      squares += velocity * velocity / steps;
    }
    EXPECT_NEAR(map[static_cast<std::size_t>(cell)] / std::sqrt(squares), 1.0, 1e-5);
    velocity_spectrum(response, cell, spectrum);
    double sum = 0.0;
    for (const double v : spectrum) sum += 0.5 * v * v;
    EXPECT_NEAR(std::sqrt(sum) / map[static_cast<std::size_t>(cell)], 1.0, 1e-12);
  }
  EXPECT_EQ(response.frequency(3), 3.0 / focus.period);
}

TEST(SkinResponse, InputIsChecked) {
  const SkinModel skin{SkinSettings{}};
  EXPECT_THROW(SkinResponse(skin, {0, 5, 2e-3}), std::invalid_argument);
  EXPECT_THROW(SkinResponse(skin, {5, 600, 2e-3}), std::invalid_argument);
  EXPECT_THROW(SkinResponse(skin, {5, 5, 0.0}), std::invalid_argument);
  EXPECT_THROW(SkinResponse(SkinModel(SkinSettings{5.0, 5.0, 0.0}), {5, 5, 2e-3}),
               std::invalid_argument);
  SkinResponse response(skin, {4, 5, 2e-3});
  EXPECT_THROW(response.prepare(0.0, 10), std::invalid_argument);
  EXPECT_THROW(response.prepare(0.3, 10), std::invalid_argument);
  EXPECT_THROW(response.prepare(0.02, 2), std::invalid_argument);
  EXPECT_THROW(response.prepare(0.02, 10, 40.0), std::invalid_argument);
  response.prepare(0.02, 10, 50.0);
  EXPECT_EQ(response.harmonics(), 1);
  response.prepare(0.02, 10);
  EXPECT_EQ(response.harmonics(), 4);
  const std::vector<double> pressure(4 * 5 * 10, 1.0);
  EXPECT_THROW(response.respond({0.01, 10, pressure}), std::invalid_argument);
  EXPECT_THROW(response.respond({0.02, 9, pressure}), std::invalid_argument);
  EXPECT_THROW(response.respond({0.02, 10, std::span(pressure).first(50)}), std::invalid_argument);
  response.respond({0.02, 10, pressure});
}

}  // namespace
}  // namespace prostm
