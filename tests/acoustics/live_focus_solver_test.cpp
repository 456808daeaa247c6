#include "prostm/acoustics/focus/live_focus_solver.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "prostm/acoustics/field/propagation.hpp"
#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"
#include "prostm/fields/moving_foci.hpp"
#include "support/heap_guard.hpp"
#include "support/load.hpp"
#include "support/only_targets.hpp"

namespace prostm {
namespace {

constexpr std::array kLive = {FocusMethod::Superposition, FocusMethod::GsPat,
                              FocusMethod::Weighted};
constexpr double kRate = 40e3;  // [Hz]

LiveFocusSettings cold(FocusMethod method) {
  return {.method = method, .iterations = 20, .warm = false};
}

Eigen::VectorXcd drives_of(const LiveFocusSolver& solver) {
  Eigen::VectorXcd q(static_cast<Eigen::Index>(solver.drive().columns()));
  for (std::size_t n = 0; n < solver.drive().columns(); ++n) {
    q[static_cast<Eigen::Index>(n)] = solver.drive().at(0, n);
  }
  return q;
}

std::vector<LiveFocus> random_foci(Random& random, int count, double apart) {
  std::vector<LiveFocus> foci;
  while (static_cast<int>(foci.size()) < count) {
    const Eigen::Vector3f p =
        Vec3(random.uniform(-0.06, 0.06), random.uniform(-0.06, 0.06), random.uniform(0.15, 0.25))
            .cast<float>();
    const bool far = std::all_of(foci.begin(), foci.end(), [&](const LiveFocus& other) {
      return static_cast<double>((p - other.p_D).norm()) > apart;
    });
    if (far) foci.push_back({p, static_cast<float>(random.uniform(0.25, 1.0))});
  }
  return foci;
}

std::vector<LiveFocus> moving(const fields::MovingFoci& foci, std::int64_t sample) {
  const double time = static_cast<double>(sample) / kRate;
  std::vector<LiveFocus> out;
  for (int f = 0; f < foci.count(); ++f) {
    out.push_back(
        {foci.position(f, time).cast<float>(), static_cast<float>(foci.amplitude(f, time))});
  }
  return out;
}

Propagation propagation_of(const std::vector<LiveFocus>& foci) {
  std::vector<Vec3> points;
  for (const LiveFocus& focus : foci) points.push_back(focus.p_D.cast<double>());
  return propagation_to(usx_array(), Medium{}, points);
}

Eigen::VectorXd amplitudes(const std::vector<LiveFocus>& foci) {
  Eigen::VectorXd a(static_cast<Eigen::Index>(foci.size()));
  for (std::size_t m = 0; m < foci.size(); ++m) {
    a[static_cast<Eigen::Index>(m)] = static_cast<double>(foci[m].amplitude);
  }
  return a;
}

/// Returns |y| relative to each focal point alone.
Eigen::VectorXd shares(const Propagation& g, const Eigen::VectorXcd& q) {
  return (g * q).cwiseAbs().cwiseQuotient(g.cwiseAbs().rowwise().sum());
}

TEST(LiveFocusSolver, FindsTheDrivesOfTheReference) {
  Random random(1);
  for (const FocusMethod method : kLive) {
    LiveFocusSolver solver(usx_array(), Medium{}, cold(method));
    for (std::uint64_t i = 0; i < test::reduced(100); ++i) {
      const auto foci = random_foci(random, 1 + random.below(8), 15e-3);
      const Propagation g = propagation_of(foci);
      const Eigen::VectorXd alone = g.cwiseAbs().rowwise().sum();
      const FocusSolution reference =
          solve_foci(g, 1e6 * amplitudes(foci).cwiseProduct(alone), {.method = method});
      solver.solve(foci);
      const Eigen::VectorXcd q = drives_of(solver);
      const double likeness =
          std::abs(q.dot(reference.drive)) / (q.norm() * reference.drive.norm());
      // iterations amplify rounding errors
      const double unlike = method == FocusMethod::Superposition ? 1e-9 : 1e-3;
      EXPECT_GT(likeness, 1.0 - unlike) << i << ", " << foci.size();
      const Eigen::VectorXd a = amplitudes(foci);
      EXPECT_NEAR(static_cast<double>(solver.level()), a.dot(shares(g, q)) / a.squaredNorm(), 1e-4);
    }
  }
}

TEST(LiveFocusSolver, OneFocalPointGetsTheRequestedAmplitude) {
  for (const FocusMethod method : kLive) {
    LiveFocusSolver solver(usx_array(), Medium{}, cold(method));
    for (const float amplitude : {0.01F, 0.5F, 0.8F}) {
      const std::vector<LiveFocus> foci = {{{0.01F, -0.02F, 0.2F}, amplitude}};
      solver.solve(foci);
      EXPECT_NEAR(shares(propagation_of(foci), drives_of(solver))[0],
                  static_cast<double>(amplitude), 1e-5);
      EXPECT_NEAR(solver.level(), 1.0F, 1e-5F);
    }
  }
}

/// Measurements of a stream.
struct Seen {
  double worst = 0.0;  ///< mean over samples of the largest error of a share
  double power = 0.0;  ///< mean of Σ (y / y alone)²
  double step = 0.0;   ///< 99.9th percentile of the phase steps [rad]
};

Seen follow(const LiveFocusSettings& settings, int count, double apart) {
  Seen seen;
  std::vector<double> steps;
  constexpr std::int64_t kSamples = 400;
  const auto streams = std::max<std::uint64_t>(1, test::reduced(20) / 5);
  for (std::uint64_t seed = 0; seed < streams; ++seed) {
    const fields::MovingFoci paths(seed, count, apart);
    LiveFocusSolver solver(usx_array(), Medium{}, settings);
    Eigen::VectorXcd before;
    for (std::int64_t i = 0; i < kSamples; ++i) {
      const auto foci = moving(paths, i);
      solver.solve(foci);
      const Eigen::VectorXcd q = drives_of(solver);
      const Eigen::VectorXd y = shares(propagation_of(foci), q), a = amplitudes(foci);
      const double level = a.dot(y) / a.squaredNorm();
      seen.worst += (y.cwiseQuotient(level * a).array() - 1.0).abs().maxCoeff();
      seen.power += y.squaredNorm();
      for (Eigen::Index n = 0; i > 0 && n < q.size(); ++n) {
        steps.push_back(std::abs(std::arg(q[n] * std::conj(before[n]))));
      }
      before = q;
    }
  }
  const auto samples = static_cast<double>(kSamples * static_cast<std::int64_t>(streams));
  seen.worst /= samples;
  seen.power /= samples;
  const auto high =
      steps.begin() + static_cast<std::ptrdiff_t>(0.999 * static_cast<double>(steps.size()));
  std::nth_element(steps.begin(), high, steps.end());
  seen.step = *high;
  return seen;
}

TEST(LiveFocusSolver, WeightedIsMoreAccurateStrongerAndSmootherThanGsPat) {
  const Seen weighted = follow({}, 4, 0.05);
  const Seen gs_pat = follow({.method = FocusMethod::GsPat, .iterations = 20}, 4, 0.05);
  EXPECT_LT(weighted.worst, 2e-3);
  EXPECT_GT(gs_pat.worst, 5.0 * weighted.worst);
  EXPECT_GT(weighted.power, 0.8);
  EXPECT_GT(weighted.power, 2.0 * gs_pat.power);
  EXPECT_LT(weighted.step, gs_pat.step);
}

TEST(LiveFocusSolver, WarmStartsImproveTheAccuracy) {
  LiveFocusSettings alone;
  alone.warm = false;
  const Seen kept = follow({}, 4, 0.05), forgotten = follow(alone, 4, 0.05);
  EXPECT_LT(kept.worst, 0.5 * forgotten.worst);
}

TEST(LiveFocusSolver, DrivesAreFiniteAndWithinOneForAnyInput) {
  Random random(3);
  const auto odd = [&](double usual) {
    const std::array strange = {0.0F,
                                -1.0F,
                                1e-38F,
                                3e38F,
                                std::numeric_limits<float>::infinity(),
                                std::numeric_limits<float>::quiet_NaN()};
    return random.below(4) == 0 ? strange[static_cast<std::size_t>(random.below(6))]
                                : static_cast<float>(usual);
  };
  for (const FocusMethod method : kLive) {
    LiveFocusSolver solver(usx_array(), Medium{}, {.method = method, .iterations = 3});
    for (std::uint64_t i = 0; i < test::reduced(4000); ++i) {
      std::vector<LiveFocus> foci(static_cast<std::size_t>(random.below(40)));
      for (LiveFocus& focus : foci) {
        focus = {{odd(random.uniform(-0.1, 0.1)), odd(random.uniform(-0.1, 0.1)),
                  odd(random.uniform(-0.1, 0.3))},
                 odd(random.uniform(0.0, 1.0))};
        if (random.below(8) == 0) focus.p_D = foci[0].p_D;
      }
      solver.solve(foci);
      const ComplexRows& q = solver.drive();
      for (std::size_t n = 0; n < q.columns(); ++n) {
        ASSERT_LE(std::abs(q.at(0, n)), 1.0F + 1e-5F) << i;
      }
      ASSERT_GE(solver.level(), 0.0F);
      ASSERT_LE(solver.level(), 1.0F + 1e-5F);
    }
  }
}

TEST(LiveFocusSolver, OmitsFocalPointsThatCannotBeReached) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  LiveFocusSolver solver(usx_array(), Medium{}, {});
  const LiveFocus good = {{0.0F, 0.0F, 0.2F}, 0.5F};
  const std::vector<LiveFocus> foci = {
      {{0.0F, 0.0F, -0.2F}, 0.5F},          {{kNan, 0.0F, 0.2F}, 0.5F},
      {{0.00525F, 0.00525F, 0.001F}, 0.5F}, {{0.0F, 0.01F, 0.2F}, 2.0F},
      {{0.0F, 0.02F, 0.2F}, 0.0F},          good};
  solver.solve(foci);
  EXPECT_NEAR(shares(propagation_of({good}), drives_of(solver))[0], 0.5, 1e-5);

  solver.solve({});
  EXPECT_EQ(drives_of(solver).norm(), 0.0);
  EXPECT_EQ(solver.level(), 0.0F);

  std::vector<LiveFocus> many(kMaxLiveFoci, good);
  solver.solve(many);
  const auto as_many = drives_of(solver);
  solver.reset();
  many.push_back({{0.05F, 0.0F, 0.2F}, 1.0F});
  solver.solve(many);
  EXPECT_EQ((drives_of(solver) - as_many).norm(), 0.0);
}

TEST(LiveFocusSolver, RoundsPhasesToTheGivenLevels) {
  const auto foci = moving(fields::MovingFoci(5, 4, 0.05), 7);
  LiveFocusSettings settings = cold(FocusMethod::Weighted);
  LiveFocusSolver any(usx_array(), Medium{}, settings);
  settings.phase_levels = 16;
  LiveFocusSolver rounded(usx_array(), Medium{}, settings);
  any.solve(foci);
  rounded.solve(foci);
  const Eigen::VectorXcd q = drives_of(any), r = drives_of(rounded);
  for (Eigen::Index n = 0; n < q.size(); ++n) {
    const double steps = std::arg(r[n]) / (2.0 * kPi / 16.0);
    EXPECT_NEAR(steps, std::round(steps), 1e-4);
    EXPECT_NEAR(std::abs(r[n]), std::abs(q[n]), 1e-5);
    EXPECT_LT(std::abs(std::arg(r[n] * std::conj(q[n]))), kPi / 16.0 + 1e-5);
  }
}

TEST(LiveFocusSolver, IsRepeatableAndDoesNotAllocate) {
  for (const FocusMethod method : kLive) {
    LiveFocusSolver solver(usx_array(), Medium{}, {.method = method});
    std::vector<std::vector<LiveFocus>> stream;
    for (std::int64_t i = 0; i < 100; ++i) {
      stream.push_back(moving(fields::MovingFoci(1, 4, 0.05), i));
    }
    const test::HeapGuard guard;
    for (const auto& foci : stream) solver.solve(foci);
    EXPECT_EQ(guard.allocations(), 0U);
    const Eigen::VectorXcd first = drives_of(solver);
    solver.reset();
    for (const auto& foci : stream) solver.solve(foci);
    EXPECT_EQ(drives_of(solver), first);
  }
}

TEST(LiveFocusSolver, EveryVectorTargetGivesTheSameDrives) {
  const fields::MovingFoci paths(2, 7, 0.02);
  for (const FocusMethod method : kLive) {
    const auto last = [&](std::int64_t targets) {
      const test::OnlyTargets only(targets);
      LiveFocusSolver solver(usx_array(), Medium{}, {.method = method, .iterations = 4});
      for (std::int64_t i = 0; i < 20; ++i) solver.solve(moving(paths, i));
      return drives_of(solver);
    };
    const Eigen::VectorXcd plain = last(test::kPlainTarget);
    for (std::int64_t left = test::vector_targets(); left != 0; left &= left - 1) {
      const Eigen::VectorXcd q = last(left & ~(left - 1));
      EXPECT_LT((q - plain).norm(), 1e-3 * plain.norm()) << hwy::TargetName(left & ~(left - 1));
    }
  }
}

TEST(LiveFocusSolver, RejectsInvalidSettings) {
  const auto make = [](const LiveFocusSettings& settings) {
    LiveFocusSolver(usx_array(), Medium{}, settings);
  };
  EXPECT_THROW(make({.method = FocusMethod::Ibp}), std::invalid_argument);
  EXPECT_THROW(make({.iterations = 0}), std::invalid_argument);
  EXPECT_THROW(make({.phase_levels = 1}), std::invalid_argument);
  EXPECT_THROW(make({.memory = 1.0}), std::invalid_argument);
  EXPECT_THROW(LiveFocusSolver(TransducerArray(), Medium{}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace prostm
