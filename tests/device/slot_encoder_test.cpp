#include "prostm/device/detail/slot_encoder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "prostm/acoustics/focus/array_output.hpp"
#include "prostm/core/random.hpp"
#include "prostm/fields/moving_foci.hpp"
#include "support/heap_guard.hpp"
#include "support/load.hpp"

namespace prostm {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
const Medium kAir;

/// Position encoded in a word, in the unit's own frame [m].
Vec3 place_of(SlotWord word) {
  Vec3 p;
  for (int axis = 0; axis < 3; ++axis) {
    auto place = static_cast<std::int64_t>(word >> (18 * axis) & 0x3FFFF);
    if (place >= 1 << 17) place -= 1 << 18;
    p[axis] = static_cast<double>(place) * 0.025e-3;
  }
  return p;
}

/// Drives of a unit's transducers as its firmware computes them from words, but in floating point.
std::vector<std::complex<double>> drives_of(std::span<const SlotWord> words, const Medium& medium) {
  const TransducerArray unit = autd3_units(std::array{Pose(Pose::Identity())});
  const double c = std::round(medium.speed_of_sound() * 64.0) / 64.0;
  const double k = kTurn * unit.frequency / c;
  std::vector<std::complex<double>> drives;
  for (const Vec3& x : unit.position) {
    std::complex<double> sum = 0.0;
    for (std::size_t s = 0; s < words.size(); ++s) {
      const Vec3 p = place_of(words[s]);
      const double phase = s == 0 ? 0.0 : static_cast<double>(words[s] >> 54 & 0xFF) / 256.0;
      sum += std::polar(1.0, k * (p - x).norm() + kTurn * phase);
    }
    const double intensity = static_cast<double>(words[0] >> 54 & 0xFF) / 255.0;
    drives.push_back(std::polar(intensity, -std::arg(sum)));
  }
  return drives;
}

std::complex<double> pressure_at(const Vec3& p_D, std::span<const std::complex<double>> drives) {
  const TransducerArray array = autd3_array();
  const Wave sound = wave(array, kAir);
  std::complex<double> sum = 0.0;
  for (std::size_t i = 0; i < drives.size(); ++i)
    sum += drives[i] * propagate(array, sound, i, p_D);
  return sum;
}

double full_scale() {
  double sum = 0.0;
  for (std::size_t i = 0; i < autd3_array().position.size(); ++i)
    sum += std::abs(propagate(autd3_array(), kAir, i, Vec3(0.0, 0.0, 0.2)));
  return sum;
}

FocusSample focus_at(const Vec3& p_D, double intensity) {
  return {p_D.cast<float>(), static_cast<float>(intensity)};
}

TEST(SlotEncoder, WritesTheWordOfAKnownFocus) {
  SlotEncoder encoder(std::array{autd3_middle()}, kAir, {.foci = 1});
  std::array<SlotWord, 1> words{};
  encoder.encode(std::array{focus_at({0.01, -0.07, 0.2}, 1.0)}, words);
  // 10 + 86.36 mm, −70 + 66.04 mm, 200 mm, in units of 0.025 mm
  const SlotWord x = 3854, y = (std::uint64_t{1} << 18) - 158, z = 8000;
  EXPECT_EQ(words[0] & ((std::uint64_t{1} << 54) - 1), x | y << 18 | z << 36);
  EXPECT_GT(words[0] >> 54, 240U);
}

TEST(SlotEncoder, GivesASingleFocalPointItsIntensity) {
  SlotEncoder encoder(std::array{autd3_middle()}, kAir, {.foci = 1});
  for (const double intensity : {0.2, 0.5, 0.9}) {
    std::array<SlotWord, 1> words{};
    const Vec3 p(0.0, 0.0, 0.2);
    encoder.encode(std::array{focus_at(p, intensity)}, words);
    EXPECT_NEAR(std::abs(pressure_at(p, drives_of(words, kAir))) / full_scale(), intensity, 0.01);
  }
}

/// Follows moving focal points of unequal intensities, the smallest 0.2 of the largest, through the
/// transducers' memory. Appends the relative errors of their ratios at the ends of samples to
/// `errors`.
void follow(int foci, int divider, std::uint64_t seed, std::vector<double>& errors) {
  const fields::MovingFoci moving(seed, foci, 0.03);
  TransducerSettings memory;
  memory.sample_rate = 40e3 / divider;
  SlotEncoder encoder(std::array{autd3_middle()}, kAir,
                      {.foci = foci, .sample_rate = memory.sample_rate});
  std::vector<SlotWord> words(static_cast<std::size_t>(encoder.slots()));
  TransducerDynamics transducers(memory, autd3_array().position.size());
  Random random(seed);
  std::vector<double> weight = {1.0};
  while (static_cast<int>(weight.size()) < foci) weight.push_back(random.uniform(0.2, 1.0));
  for (int s = 0; s < 120; ++s) {
    std::vector<FocusSample> sample;
    for (int f = 0; f < foci; ++f) {
      const double share = 0.9 * weight[static_cast<std::size_t>(f)];
      sample.push_back(focus_at(moving.position(f, s / memory.sample_rate), share));
    }
    encoder.encode(sample, words);
    transducers.step(drives_of(words, kAir));
    if (s < 20) continue;  // until the first solution is found
    std::vector<double> reached;
    double sum = 0.0, all = 0.0;
    for (std::size_t f = 0; f < sample.size(); ++f) {
      reached.push_back(std::abs(pressure_at(sample[f].p_D.cast<double>(), transducers.output())));
      sum += weight[f] * reached[f];
      all += weight[f] * weight[f];
    }
    for (std::size_t f = 0; f < sample.size(); ++f)
      errors.push_back(std::abs(reached[f] * all / sum / weight[f] - 1.0));
  }
}

// On these paths none is off; on others a few in 10 000 are, mostly with two focal points within a
// wavelength of each other.
TEST(SlotEncoder, ReachesUnequalIntensitiesDespiteTheTransducersMemory) {
  for (const int divider : {4, 6, 8}) {
    for (const int foci : {2, 3, 4}) {
      std::vector<double> shares;
      for (std::uint64_t seed = 1; seed <= 1 + test::reduced(9); ++seed)
        follow(foci, divider, seed, shares);
      std::sort(shares.begin(), shares.end());
      std::printf("%d foci, divider %d: median %.4f, 99th percentile %.3f, largest %.3f of %zu\n",
                  foci, divider, shares[shares.size() / 2], shares[shares.size() * 99 / 100],
                  shares.back(), shares.size());
      EXPECT_LT(shares[shares.size() / 2], 0.003);
      EXPECT_LT(shares[shares.size() * 99 / 100], 0.03);
      EXPECT_LT(shares.back(), 0.1);
    }
  }
}

TEST(SlotEncoder, EncodesThePhasesOfItsSolver) {
  // the solver that it uses, without rounding
  constexpr int kFoci = 4;
  const TransducerArray array = autd3_array();
  LiveFocusSettings settings;
  settings.iterations = 3;
  settings.full_scale = full_scale();
  settings.adds_phasors = true;
  settings.phase_levels = 256;
  settings.memory = std::exp(-1.0 / (time_constant({}) * 6.7e3));
  LiveFocusSolver solver(array, kAir, settings);
  SlotEncoder encoder(std::array{autd3_middle()}, kAir, {.foci = kFoci, .sample_rate = 6.7e3});
  const fields::MovingFoci moving(5, kFoci, 0.03);
  const double k = wave(array, kAir).number;
  std::array<SlotWord, 2 * kFoci> words{};
  std::vector<double> errors;
  double before = 0.0;
  for (std::uint64_t s = 0; s < test::reduced(400); ++s) {
    std::array<FocusSample, kFoci> sample;
    std::array<LiveFocus, kFoci> foci;
    for (int f = 0; f < kFoci; ++f) {
      const auto i = static_cast<std::size_t>(f);
      sample[i] = focus_at(moving.position(f, static_cast<double>(s) / 6.7e3), 0.9 - 0.2 * f);
      foci[i] = {sample[i].p_D, sample[i].intensity};
    }
    encoder.encode(sample, words);
    solver.solve(foci);
    // the units take the first slot's phase as 0: half the phase difference of the first two slots
    const double reference = -std::round(0.5 * static_cast<double>(words[1] >> 54 & 0xFF));
    solver.play(std::polar(1.0F, static_cast<float>(kTurn / 256.0 * (reference - before))));
    before = reference;
    const auto told = drives_of(words, kAir);
    std::vector<std::complex<double>> wanted;
    std::complex<double> turn = 0.0;  // the common phase is arbitrary
    for (std::size_t n = 0; n < told.size(); ++n) {
      std::complex<double> sum = 0.0;
      for (std::size_t f = 0; f < kFoci; ++f) {
        const double away = (sample[f].p_D.cast<double>() - array.position[n]).norm();
        sum += std::conj(std::complex<double>(solver.coefficient(f))) * std::polar(2.0, k * away);
      }
      wanted.push_back(std::conj(sum));
      turn += told[n] * sum;
    }
    for (std::size_t n = 0; n < told.size(); ++n) {
      if (std::abs(wanted[n]) < 0.1 * 2 * kFoci) continue;
      const double error = std::arg(told[n] * std::conj(wanted[n]) * std::conj(turn));
      errors.push_back(std::abs(error) / kTurn * 256.0);
    }
  }
  std::sort(errors.begin(), errors.end());
  // where the sum is a tenth of the number of slots, rounding positions to 0.025 mm and phases to
  // 1/256 turn alone causes an error of 1.05 (standard deviation); elsewhere it is smaller
  const auto above = errors.end() - std::upper_bound(errors.begin(), errors.end(), 2.0);
  EXPECT_LT(static_cast<double>(above), 1e-3 * static_cast<double>(errors.size()));
  std::printf(
      "phases: median %.2f, 99th percentile %.2f, largest %.2f of 1/256 turn, %td of %zu above 2\n",
      errors[errors.size() / 2], errors[errors.size() * 99 / 100], errors.back(), above,
      errors.size());
}

TEST(SlotEncoder, RoundsPositionsToAtMostHalfAStepInEveryUnit) {
  const Pose beside = Pose(Eigen::Translation3d(0.2, 0.0, 0.01)) *
                      Eigen::AngleAxisd(-0.4, Vec3::UnitY()) * autd3_middle();
  const std::array units{autd3_middle(), beside};
  SlotEncoder encoder(units, kAir, {.foci = 2});
  std::vector<SlotWord> words(static_cast<std::size_t>(2 * encoder.slots()));
  Random random(3);
  for (std::uint64_t i = 0; i < test::reduced(10'000); ++i) {
    std::array<FocusSample, 2> sample;
    for (FocusSample& focus : sample) {
      focus =
          focus_at({random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform(0.1, 0.3)},
                   random.uniform(0.0, 1.0));
    }
    encoder.encode(sample, words);
    for (std::size_t w = 0; w < words.size(); ++w) {
      const Pose& X_DU = units[w / static_cast<std::size_t>(encoder.slots())];
      const FocusSample& focus = sample[w % static_cast<std::size_t>(encoder.slots()) / 2];
      const Vec3 told = X_DU * place_of(words[w]);
      EXPECT_LT((told - focus.p_D.cast<double>()).norm(), 0.025e-3);
    }
  }
}

TEST(SlotEncoder, IsSilentForInvalidNumbers) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const FocusSample good = focus_at({0.0, 0.0, 0.2}, 0.5);
  const std::array bad = {FocusSample{{nan, 0.0F, 0.2F}, 0.5F},
                          FocusSample{{0.0F, 0.0F, 0.2F}, nan},
                          FocusSample{{0.0F, 9.0F, 0.2F}, 0.5F}};
  for (const FocusSample& focus : bad) {
    SlotEncoder encoder(std::array{autd3_middle()}, kAir, {.foci = 2});
    std::array<SlotWord, 4> words{};
    encoder.encode(std::array{focus, focus}, words);
    EXPECT_EQ(words[0] >> 54, 0U);
    encoder.encode(std::array{good, focus}, words);
    EXPECT_NEAR(std::abs(pressure_at({0.0, 0.0, 0.2}, drives_of(words, kAir))) / full_scale(), 0.5,
                0.01);
    SlotEncoder equal(std::array{autd3_middle()}, kAir, {.foci = 2, .own_intensities = false});
    equal.encode(std::array{focus, good}, std::span(words).first(2));
    EXPECT_NEAR(std::abs(pressure_at({0.0, 0.0, 0.2}, drives_of(std::span(words).first(2), kAir))) /
                    full_scale(),
                0.5, 0.01);
  }
}

TEST(SlotEncoder, KeepsPhasesWhileTheFirstFocalPointIsSilent) {
  SlotEncoder encoder(std::array{autd3_middle()}, kAir, {.foci = 2});
  std::array<SlotWord, 4> words{};
  const Vec3 p(-0.03, 0.0, 0.2), q(0.03, 0.01, 0.2);
  for (int s = 0; s < 10; ++s)
    encoder.encode(std::array{focus_at(p, 0.5), focus_at(q, 0.5)}, words);
  for (int s = 0; s < 40; ++s) {
    const double left = std::max(0.0, 0.5 - 0.025 * s);
    const auto before = pressure_at(q, drives_of(words, kAir));
    encoder.encode(std::array{focus_at(p, left), focus_at(q, 0.5)}, words);
    const auto now = pressure_at(q, drives_of(words, kAir));
    EXPECT_LT(std::abs(std::arg(now / before)), 0.3) << s;
  }
}

TEST(SlotEncoder, DoesNotAllocate) {
  SlotEncoder encoder(std::array{autd3_middle()}, kAir, {.foci = 4});
  const fields::MovingFoci moving(1, 4, 0.03);
  std::array<SlotWord, 8> words{};
  const test::HeapGuard guard;
  for (int s = 0; s < 100; ++s) {
    std::array<FocusSample, 4> sample;
    for (int f = 0; f < 4; ++f)
      sample[static_cast<std::size_t>(f)] = focus_at(moving.position(f, s / 1e4), 0.8);
    encoder.encode(sample, words);
  }
  EXPECT_EQ(guard.allocations(), 0U);
}

TEST(SlotEncoder, ReportsHowManyFocalPointsFit) {
  const std::array unit{autd3_middle()};
  EXPECT_EQ(SlotEncoder(unit, kAir, {.foci = 4}).slots(), 8);
  EXPECT_EQ(SlotEncoder(unit, kAir, {.foci = 8, .own_intensities = false}).slots(), 8);
  EXPECT_THROW(SlotEncoder(unit, kAir, {.foci = 5}), std::invalid_argument);
  EXPECT_THROW(SlotEncoder(unit, kAir, {.foci = 9, .own_intensities = false}),
               std::invalid_argument);
}

}  // namespace
}  // namespace prostm
