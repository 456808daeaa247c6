#include "prostm/acoustics/skin/bounded_skin.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "acoustics/skin_loops.hpp"
#include "prostm/acoustics/skin/skin_percept.hpp"

namespace prostm {
namespace {

using Complex = std::complex<double>;

/// K_0(z) = ∫_0^∞ e^{−z cosh t} dt, Re z > 0, by the trapezoidal rule.
Complex bessel_k0(Complex z) {
  constexpr double kStep = 1e-4;
  Complex sum = 0.5 * std::exp(-z);
  for (double t = kStep; z.real() * std::cosh(t) < 45.0; t += kStep) {
    sum += std::exp(-z * std::cosh(t));
  }
  return kStep * sum;
}

/// The surface wave of a point load of 1 N on skin without edges, (S16).
Complex free_wave(const SkinModel& skin, double omega, double radius) {
  const Complex k = skin.surface_wave_number(omega);
  return skin.wave_strength(omega) / (2.0 * kPi) * bessel_k0(Complex(0.0, 1.0) * k * radius);
}

/// Skin whose waves decay within about 2 cm, so that edges at 10 cm are far away.
SkinModel lossy_skin() {
  SkinSettings settings;
  settings.loss = 0.03;
  return SkinModel(settings);
}

std::vector<std::uint8_t> all_skin(const SkinPatch& patch) {
  return std::vector<std::uint8_t>(patch.size(), 1);
}

/// An L of skin, so that there are edges within the patch.
std::vector<std::uint8_t> angle(const SkinPatch& patch) {
  std::vector<std::uint8_t> out(patch.size(), 1);
  for (int j = 0; j < patch.rows / 2; ++j) {
    for (int i = patch.cols / 2; i < patch.cols; ++i) {
      out[static_cast<std::size_t>(j * patch.cols + i)] = 0;
    }
  }
  return out;
}

/// Pressure of a loop of one cell, cos(2πt/T) there: P_1 = 1 Pa.
std::vector<double> one_cell(const SkinPatch& patch, std::size_t cell, int samples) {
  std::vector<double> out(patch.size() * static_cast<std::size_t>(samples), 0.0);
  for (int k = 0; k < samples; ++k) {
    out[static_cast<std::size_t>(k) * patch.size() + cell] = std::cos(2.0 * kPi * k / samples);
  }
  return out;
}

/// A focus at rest with pressure cos(2πt/T), 16 samples; 0 where it is below 1e-4 of its maximum.
std::vector<double> focus_at(const SkinPatch& patch, int row, int col) {
  std::vector<double> out;
  for (int k = 0; k < 16; ++k) {
    for (int j = 0; j < patch.rows; ++j) {
      for (int i = 0; i < patch.cols; ++i) {
        const double r = std::hypot(j - row, i - col) * patch.cell;
        const double p = std::exp(-0.5 * r * r / (5e-3 * 5e-3));
        out.push_back(p > 1e-4 ? p * std::cos(2.0 * kPi * k / 16.0) : 0.0);
      }
    }
  }
  return out;
}

TEST(BoundedWaves, ModesOfARectangleAreCosines) {
  constexpr int kRows = 24, kCols = 40;
  constexpr double kLong = 0.1;  // the edge along x [m]
  const double step = kLong / kCols;
  const SkinModel skin{SkinSettings{}};
  BoundedWaves waves(kRows, kCols, step, std::vector<std::uint8_t>(kRows * kCols, 1));
  const double omega = 2.0 * kPi * 200.0;
  const Complex k = skin.surface_wave_number(omega), strength = skin.wave_strength(omega);
  waves.add(k, strength);
  for (const auto& [m, n] : {std::pair{0, 0}, {1, 0}, {2, 3}, {7, 4}}) {
    Eigen::VectorXcd mode(waves.corners());
    for (int j = 0; j <= kRows; ++j) {
      for (int i = 0; i <= kCols; ++i) {
        mode[waves.corner(j, i)] = std::cos(m * kPi * i / kCols) * std::cos(n * kPi * j / kRows);
      }
    }
    const double kx = m * kPi / kLong, ky = n * kPi / (kRows * step);
    const Complex exact = strength / (kx * kx + ky * ky - k * k);
    const double error = (waves.respond(0, mode) - exact * mode).cwiseAbs().maxCoeff();
    EXPECT_LT(error, 2e-3 * std::abs(exact)) << m << " " << n << ": " << error / std::abs(exact);
  }
}

TEST(BoundedWaves, ErrorsFallWithTheFourthPowerOfTheStep) {
  const SkinModel skin{SkinSettings{}};
  const double omega = 2.0 * kPi * 300.0, edge = 0.06;
  const Complex k = skin.surface_wave_number(omega), strength = skin.wave_strength(omega);
  std::vector<double> errors;
  for (const int cells : {20, 40}) {
    BoundedWaves waves(1, cells, edge / cells,
                       std::vector<std::uint8_t>(static_cast<std::size_t>(cells), 1));
    waves.add(k, strength);
    Eigen::VectorXcd mode(waves.corners());
    for (int i = 0; i <= cells; ++i) {
      for (int j = 0; j < 2; ++j) mode[waves.corner(j, i)] = std::cos(6.0 * kPi * i / cells);
    }
    const Complex exact = strength / (std::pow(6.0 * kPi / edge, 2) - k * k);
    errors.push_back((waves.respond(0, mode) - exact * mode).cwiseAbs().maxCoeff());
  }
  EXPECT_NEAR(errors[0] / errors[1], 16.0, 1.0);
}

TEST(BoundedWaves, APointLoadFarFromTheEdgesEmitsHankelsWave) {
  constexpr int kCells = 120;
  constexpr double kStep = 2e-3;
  const SkinModel skin = lossy_skin();
  BoundedWaves waves(kCells, kCells, kStep, std::vector<std::uint8_t>(kCells * kCells, 1));
  for (const double frequency : {100.0, 200.0, 300.0}) {
    const double omega = 2.0 * kPi * frequency;
    waves.clear();
    waves.add(skin.surface_wave_number(omega), skin.wave_strength(omega));
    Eigen::VectorXcd load = Eigen::VectorXcd::Zero(waves.corners());
    load[waves.corner(kCells / 2, kCells / 2)] = 1.0 / (kStep * kStep);
    const Eigen::VectorXcd found = waves.respond(0, load);
    for (const int away : {8, 15, 25}) {
      const Complex exact = free_wave(skin, omega, away * kStep);
      const Complex here = found[waves.corner(kCells / 2, kCells / 2 + away)];
      EXPECT_LT(std::abs(here - exact), 0.02 * std::abs(exact))
          << frequency << " Hz, " << away * kStep << " m: " << here / exact;
    }
  }
}

// Near a load the half-space has additional terms: 1/r at the load, and shear waves.
TEST(SkinModel, FarFromALoadTheHalfSpaceHasOnlyItsSurfaceWave) {
  const SkinModel skin{SkinSettings{}};
  const SkinPatch patch{1, 121, 2e-3};
  const double period = 1.0 / 300.0, omega = 2.0 * kPi / period;
  SkinResponse response(skin, patch);
  response.prepare(period, 8, 301.0);
  response.respond({period, 8, one_cell(patch, 0, 8)});
  const auto excess = [&](int cell) {
    const Complex wave = free_wave(skin, omega, cell * patch.cell) * patch.cell * patch.cell;
    return std::abs(response.displacement(1)[static_cast<std::size_t>(cell)] / wave - 1.0);
  };
  EXPECT_LT(excess(45), 0.15);
  EXPECT_LT(excess(90), 0.1);
  EXPECT_GT(excess(5), 0.5);
}

TEST(BoundedSkin, MatchesTheHalfSpaceFarFromItsEdges) {
  const SkinModel skin = lossy_skin();
  const SkinPatch patch{36, 36, 5e-3};
  test::CirclingFocus focus;
  focus.sigma = 5e-3;
  const int samples = 64;
  const std::vector<double> pressure = test::sampled(focus, patch, samples);
  SkinResponse free(skin, patch);
  BoundedSkin bounded(skin, patch, all_skin(patch));
  free.prepare(focus.period, samples);
  bounded.prepare(focus.period, samples);
  free.respond({focus.period, samples, pressure});
  bounded.respond({focus.period, samples, pressure});
  std::vector<double> expected(patch.size()), found(patch.size());
  percept_map(free, expected);
  percept_map(bounded, found);
  double largest = 0.0, difference = 0.0;
  for (std::size_t c = 0; c < patch.size(); ++c) {
    largest = std::max(largest, expected[c]);
    difference = std::max(difference, std::abs(expected[c] - found[c]));
  }
  EXPECT_LT(difference, 0.01 * largest) << difference / largest;
  EXPECT_NEAR(perceived_intensity(bounded) / perceived_intensity(free), 1.0, 0.01);
}

// A focus at a moves b as much as one at b moves a, each weighted by the pressure of its focus.
TEST(BoundedSkin, IsReciprocal) {
  const SkinPatch patch{16, 20, 4e-3};
  BoundedSkin skin(SkinModel{SkinSettings{}}, patch, angle(patch));
  const double period = 6e-3;
  skin.prepare(period, 16, 200.0);
  const auto a = focus_at(patch, 4, 4), b = focus_at(patch, 11, 15);
  const auto seen = [&](const std::vector<double>& from, const std::vector<double>& to) {
    skin.respond({period, 16, from});
    Complex sum = 0.0;  // the first sample of `to` is its amplitude
    for (std::size_t c = 0; c < patch.size(); ++c) sum += to[c] * skin.displacement(1)[c];
    return sum;
  };
  const Complex there = seen(a, b), back = seen(b, a);
  EXPECT_GT(std::abs(there), 0.0);
  EXPECT_LT(std::abs(there - back), 5e-3 * std::abs(there)) << there / back;
}

TEST(BoundedSkin, WavesReflectAtAnEdgeAndDoNotCrossIt) {
  const SkinPatch patch{20, 20, 4e-3};
  const SkinModel model{SkinSettings{}};
  auto mask = all_skin(patch);
  for (int j = 0; j < patch.rows; ++j) mask[static_cast<std::size_t>(j * patch.cols + 10)] = 0;
  BoundedSkin cut(model, patch, mask);
  SkinResponse free(model, patch), near_part(model, patch, SkinPart::Near);
  const double period = 5e-3;
  const auto pressure = focus_at(patch, 10, 4);
  cut.prepare(period, 16, 200.0);
  cut.respond({period, 16, pressure});
  for (SkinResponse* response : {&free, &near_part}) {
    response->prepare(period, 16, 200.0);
    response->respond({period, 16, pressure});
  }
  const auto at = [](const SkinMotion& motion, std::size_t col) {
    return motion.displacement(1)[10 * 20 + col];
  };
  EXPECT_EQ(at(cut, 10), 0.0);
  EXPECT_LT(std::abs(at(cut, 14) - at(near_part, 14)), 0.01 * std::abs(at(near_part, 14)));
  EXPECT_GT(std::abs(at(cut, 9) / at(free, 9) - 1.0), 0.1);
}

TEST(BoundedSkin, ConvergesAsItsStepsShrink) {
  const SkinPatch patch{16, 20, 4e-3};
  const auto mask = angle(patch);
  test::CirclingFocus focus;
  const int samples = 64;
  const auto pressure = test::sampled(focus, patch, samples);
  const auto percept = [&](double finest) {
    BoundedSkin skin(SkinModel{SkinSettings{}}, patch, mask, finest);
    skin.prepare(focus.period, samples, 300.0);
    skin.respond({focus.period, samples, pressure});
    std::vector<double> out(patch.size());
    percept_map(skin, out);
    return out;
  };
  const auto coarse = percept(2e-3), fine = percept(1e-3), finest = percept(0.5e-3);
  double of_coarse = 0.0, of_fine = 0.0, largest = 0.0;
  for (std::size_t c = 0; c < patch.size(); ++c) {
    of_coarse = std::max(of_coarse, std::abs(coarse[c] - finest[c]));
    of_fine = std::max(of_fine, std::abs(fine[c] - finest[c]));
    largest = std::max(largest, finest[c]);
  }
  EXPECT_LT(of_coarse, 0.03 * largest) << of_coarse / largest;
  EXPECT_LT(of_fine, 0.6 * of_coarse) << of_fine / largest;
}

TEST(BoundedSkin, PressureOffTheSkinDoesNothing) {
  const SkinPatch patch{8, 8, 5e-3};
  auto mask = all_skin(patch);
  mask[20] = 0;
  BoundedSkin skin(SkinModel{SkinSettings{}}, patch, mask);
  skin.prepare(0.01, 8, 300.0);
  skin.respond({0.01, 8, one_cell(patch, 20, 8)});
  for (const Complex& w : skin.displacement(1)) EXPECT_EQ(w, 0.0);
}

TEST(BoundedSkin, SettingsAreChecked) {
  const SkinModel skin{SkinSettings{}};
  const SkinPatch patch{8, 8, 5e-3};
  EXPECT_THROW(BoundedSkin(skin, patch, std::vector<std::uint8_t>(64, 0)), std::invalid_argument);
  EXPECT_THROW(BoundedSkin(skin, patch, std::vector<std::uint8_t>(63, 1)), std::invalid_argument);
  EXPECT_THROW(BoundedSkin(skin, patch, all_skin(patch), 6e-3), std::invalid_argument);
  EXPECT_THROW(BoundedSkin(skin, {0, 8, 5e-3}, {}), std::invalid_argument);
  BoundedSkin bounded(skin, patch, all_skin(patch));
  EXPECT_THROW(bounded.prepare(0.5, 8), std::invalid_argument);
  bounded.prepare(0.01, 8);
  EXPECT_THROW(bounded.respond({0.02, 8, std::vector<double>(512)}), std::invalid_argument);
}

}  // namespace
}  // namespace prostm
