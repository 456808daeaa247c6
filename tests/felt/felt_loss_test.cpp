#include "prostm/felt/felt_loss.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "prostm/core/random.hpp"
#include "prostm/felt/detail/felt_kernels.hpp"
#include "prostm/felt/step_path.hpp"
#include "prostm/fields/fields.hpp"
#include "support/heap_guard.hpp"
#include "support/only_targets.hpp"

namespace prostm {
namespace {

template <class Real>
FeltSkins<Real> skins() {
  FeltSkins<Real> out(2);
  FocusResponseMaker maker;
  SkinSettings slow;
  slow.slow_speed *= 0.7;
  slow.fast_speed *= 0.7;
  maker.make(SkinModel(SkinSettings()), 4.3e-3, 20e-3, out[0]);
  maker.make(SkinModel(slow), 4.3e-3, 20e-3, out[1]);
  return out;
}

FeltCells cells_of(fields::Pattern pattern) {
  const TargetField field = fields::make(pattern, 10);
  FeltCells cells(kFeltCells);
  cells.set(field, max_pressure(field));
  return cells;
}

/// Sources anywhere on a raster of the generated fields, with random spectra and amplitudes.
template <class Real>
struct Sources {
  Sources(std::uint64_t seed, std::size_t count) {
    Random random(seed);
    for (std::size_t j = 0; j < count; ++j) {
      FeltSource<Real>& source = all.emplace_back();
      source.x = static_cast<Real>(random.uniform(20.0, 140.0));
      source.y = static_cast<Real>(random.uniform(20.0, 140.0));
      for (Real& part : source.spectrum) part = static_cast<Real>(random.uniform(-1.0, 1.0));
      amplitude.push_back(static_cast<Real>(random.uniform(-0.2, 1.0)));
    }
  }
  std::vector<FeltSource<Real>> all;
  std::vector<Real> amplitude;
};

constexpr std::size_t kSources = 12;
constexpr FeltWeights kWeights{.fine = 0.3, .energy = 0.2, .loudness = 0.2, .quiet = 3.0};

/// The loss of given sources, in double precision.
struct Judge {
  explicit Judge(fields::Pattern pattern) : loss(2, kFeltCells, kSources, kWeights, true) {
    loss.set_target(cells_of(pattern));
  }
  double operator()(const Sources<double>& sources) {
    loss.set_sources(tables, sources.all);
    return loss.evaluate(sources.amplitude);
  }
  FeltSkins<double> tables = skins<double>();
  FeltLoss<double> loss;
};

TEST(FeltLoss, HasTheGradientOfItsValues) {
  for (const fields::Pattern pattern : fields::kPatterns) {
    Judge judge(pattern);
    Sources<double> sources(7, kSources);
    judge(sources);
    judge.loss.keep_loudness(sources.amplitude, 1.1);
    for (double& a : sources.amplitude) a *= 0.6;  // below the amplitude that is kept
    std::vector<double> by_amplitude(kSources), by_x(kSources), by_y(kSources), by_time(kSources);
    judge.loss.evaluate(sources.amplitude);
    judge.loss.gradient(by_amplitude);
    judge.loss.slide(sources.amplitude, by_x, by_y);
    judge.loss.turn(sources.amplitude, 2, by_time);
    const auto expect = [&](double gradient, double step, const auto& change) {
      Sources<double> before = sources, after = sources;
      change(before, -step);
      change(after, step);
      const double difference = (judge(after) - judge(before)) / (2.0 * step);
      EXPECT_NEAR(gradient, difference, 1e-6 * (1.0 + std::abs(gradient)));
    };
    for (std::size_t j = 0; j < kSources; ++j) {
      expect(by_amplitude[j], 1e-5, [&](auto& s, double d) { s.amplitude[j] += d; });
      expect(by_x[j], 1e-4, [&](auto& s, double d) { s.all[j].x += d; });
      expect(by_y[j], 1e-4, [&](auto& s, double d) { s.all[j].y += d; });
      expect(by_time[j], 1e-6, [&](auto& s, double d) {
        auto& spectrum = s.all[j].spectrum;
        for (std::size_t n = 0; n < kFeltParts / 2; ++n) {
          const double angle = -2.0 * M_PI * (2.0 + static_cast<double>(n)) * d;
          const double re = spectrum[n], im = spectrum[n + kFeltParts / 2];
          spectrum[n] = re * std::cos(angle) - im * std::sin(angle);
          spectrum[n + kFeltParts / 2] = re * std::sin(angle) + im * std::cos(angle);
        }
      });
    }
  }
}

/// Compares both precisions on this vector target.
void expect_same_in_single_precision() {
  const FeltSkins<double> tables = skins<double>();
  const FeltSkins<float> short_tables = skins<float>();
  FeltLoss<double> loss(2, kFeltCells, 64, kWeights, true);
  FeltLoss<float> short_loss(2, kFeltCells, 64, kWeights, true);
  for (const fields::Pattern pattern : fields::kPatterns) {
    for (const std::size_t count : {1, 2, 7, 64}) {  // including odd numbers
      const Sources<double> sources(count, count);
      const Sources<float> short_sources(count, count);
      loss.set_target(cells_of(pattern));
      short_loss.set_target(cells_of(pattern));
      loss.set_sources(tables, sources.all);
      short_loss.set_sources(short_tables, short_sources.all);
      std::vector<double> gradient(count), x(count), y(count);
      std::vector<float> short_gradient(count), short_x(count), short_y(count);
      const double value = loss.evaluate(sources.amplitude);
      EXPECT_NEAR(static_cast<double>(short_loss.evaluate(short_sources.amplitude)), value,
                  2e-4 * std::abs(value));
      loss.gradient(gradient);
      short_loss.gradient(short_gradient);
      loss.slide(sources.amplitude, x, y);
      short_loss.slide(short_sources.amplitude, short_x, short_y);
      const auto expect_near = [](const std::vector<float>& a, const std::vector<double>& b) {
        double square = 0.0, difference = 0.0;
        for (std::size_t j = 0; j < a.size(); ++j) {
          square += b[j] * b[j];
          difference += std::pow(static_cast<double>(a[j]) - b[j], 2);
        }
        EXPECT_LT(std::sqrt(difference), 0.01 * std::sqrt(square) + 1e-9);
      };
      expect_near(short_gradient, gradient);
      expect_near(short_x, x);
      expect_near(short_y, y);
    }
  }
}

TEST(FeltLoss, IsTheSameInSinglePrecisionOnEveryVectorTarget) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    const test::OnlyTargets only(target);
    SCOPED_TRACE(hwy::TargetName(target));
    expect_same_in_single_precision();
  }
}

TEST(FeltLoss, MeasuresALackIndependentlyOfTheUnit) {
  Judge judge(fields::Pattern::FourPlumes);
  FeltLoss<double> lack(2, kFeltCells, kSources,
                        {.fine = 0.3, .energy = 0.2, .loudness = 0.0, .quiet = 0.0}, false);
  lack.set_target(cells_of(fields::Pattern::FourPlumes));
  Sources<double> sources(3, kSources);
  lack.set_sources(judge.tables, sources.all);
  const double value = lack.evaluate(sources.amplitude), loudness = lack.loudness();
  EXPECT_GT(value, 0.0);
  for (double& a : sources.amplitude) a *= 1000.0;
  EXPECT_NEAR(lack.evaluate(sources.amplitude), value, 1e-12);
  EXPECT_NEAR(lack.loudness(), 1000.0 * loudness, 1e-9 * loudness);
}

template <class Real>
void expect_finite_in_silence() {
  FeltLoss<Real> loss(2, kFeltCells, kSources, kWeights, true);
  loss.set_target(cells_of(fields::Pattern::Letter));
  const Sources<Real> sources(1, kSources);
  loss.set_sources(skins<Real>(), sources.all);
  const Real felt = loss.keep_loudness(sources.amplitude, 1);
  const std::vector<Real> silence(kSources);
  const Real silent = loss.evaluate(silence);
  EXPECT_TRUE(std::isfinite(silent));
  EXPECT_GT(silent, felt);
  std::vector<Real> gradient(kSources), x(kSources), y(kSources), turn(kSources);
  loss.gradient(gradient);
  loss.slide(silence, x, y);
  loss.turn(silence, 2, turn);
  for (const auto& values : {gradient, x, y, turn}) {
    for (const Real value : values) EXPECT_TRUE(std::isfinite(value));
  }
}

TEST(FeltLoss, IsFiniteIfNothingIsFelt) {
  expect_finite_in_silence<float>();
  expect_finite_in_silence<double>();
}

TEST(FeltLoss, ItsCoarseLackIsTheLossWithoutOtherTerms) {
  const Judge judge(fields::Pattern::FourPlumes);
  const Sources<double> sources(3, kSources);
  const auto loss_with = [&](const FeltWeights& weights) {
    FeltLoss<double> loss(2, kFeltCells, kSources, weights, false);
    loss.set_target(cells_of(fields::Pattern::FourPlumes));
    loss.set_sources(judge.tables, sources.all);
    return loss;
  };
  FeltLoss<double> alone = loss_with({.fine = 0.0, .energy = 0.0, .loudness = 0.0, .quiet = 0.0});
  FeltLoss<double> with_all = loss_with(kWeights);
  const double value = alone.evaluate(sources.amplitude);
  with_all.evaluate(sources.amplitude);
  EXPECT_NEAR(alone.coarse_lack(), value, 1e-12);
  EXPECT_NEAR(with_all.coarse_lack(), value, 1e-12);
  EXPECT_GT(with_all.lack(), value);
}

TEST(FeltLoss, DoesNotAllocate) {
  FeltLoss<float> loss(2, kFeltCells, 64, kWeights, true);
  const FeltSkins<float> tables = skins<float>();
  const Sources<float> sources(5, 64);
  const FeltCells small = cells_of(fields::Pattern::OnePlume);
  std::vector<float> gradient(64), x(64), y(64);
  const test::HeapGuard guard;
  loss.set_target(small);
  loss.set_sources(tables, sources.all);
  loss.keep_loudness(sources.amplitude, 1.0F);
  loss.evaluate(sources.amplitude);
  loss.gradient(gradient);
  loss.slide(sources.amplitude, x, y);
  loss.turn(sources.amplitude, 2, x);
  EXPECT_EQ(guard.allocations(), 0U);
}

TEST(FeltCells, PreserveAreaAndPressure) {
  for (const fields::Pattern pattern : fields::kPatterns) {
    TargetField field = fields::make(pattern, 30);
    field.weight.assign(field.size(), 2.0);
    const double largest = max_pressure(field);
    FeltCells cells(kFeltCells);
    cells.set(field, largest);
    double area = 0.0, pressure = 0.0;
    for (const FeltCells::Cell& cell : cells.cells()) {
      area += cell.area;
      pressure += cell.area * cell.pressure;
    }
    const auto skin = static_cast<double>(std::count(field.skin.begin(), field.skin.end(), 1));
    EXPECT_NEAR(area, 1.0, 1e-9);
    EXPECT_NEAR(pressure, total_pressure(field) / largest / skin, 1e-6);
    EXPECT_LE(cells.cells().size(), kFeltCells);
  }
}

TEST(FeltCells, FitAnyRaster) {
  FeltCells cells(kFeltCells);
  for (const int edge : {1, 2, 31, 200, 512}) {
    for (const double cell : {1e-3, 8e-3, 20e-3}) {
      TargetField field;
      field.resize(edge, edge);
      field.cell = cell;
      field.skin.assign(field.size(), 1);
      field.pressure.assign(field.size(), 1.0);
      cells.set(field, 1.0);
      EXPECT_GE(cells.cells().size(), 1U);
      EXPECT_LE(cells.cells().size(), kFeltCells);
    }
  }
}

TEST(StepPath, PassesItsPointsInTimeWithTheMatchingGradient) {
  Random random(2);
  constexpr std::size_t kPoints = 9;
  for (int draw = 0; draw < 200; ++draw) {
    std::vector<double> x, y, by_time, by_share;
    for (std::size_t i = 0; i < kPoints; ++i) {
      const double angle = 2.0 * M_PI * static_cast<double>(i) / kPoints;
      x.push_back(20.0 * std::cos(angle) + random.uniform(-4.0, 4.0));
      y.push_back(30.0 * std::sin(angle) + random.uniform(-4.0, 4.0));
      by_time.push_back(random.uniform(-1.0, 1.0));
      by_share.push_back(random.uniform(-1.0, 1.0));
    }
    StepPath<double> path;
    const auto value = [&] {
      path.set(x, y, 1);
      double sum = 0.0, shares = 0.0;
      for (std::size_t i = 0; i < kPoints; ++i) {
        sum += by_time[i] * path.time(i) + by_share[i] * path.share(i);
        shares += path.share(i);
      }
      EXPECT_NEAR(shares, 2.0, 1e-12);
      return sum;
    };
    value();
    std::vector<double> gradient_x(kPoints, 0.0), gradient_y(kPoints, 0.0);
    path.add_gradient(by_time, by_share, gradient_x, gradient_y);
    const auto difference = [&](double& at) {
      const double here = at, h = 1e-5;
      at = here + h;
      const double after = value();
      at = here - h;
      const double before = value();
      at = here;
      return (after - before) / (2.0 * h);
    };
    for (std::size_t i = 0; i < kPoints; ++i) {
      ASSERT_NEAR(gradient_x[i], difference(x[i]), 1e-8);
      ASSERT_NEAR(gradient_y[i], difference(y[i]), 1e-8);
    }
  }
}

}  // namespace
}  // namespace prostm
