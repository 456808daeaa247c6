#include "prostm/acoustics/focus/focus_solver.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "prostm/acoustics/array/array.hpp"
#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"
#include "support/load.hpp"

namespace prostm {
namespace {

constexpr std::array kMethods = {FocusMethod::Superposition, FocusMethod::Ibp,
                                 FocusMethod::GsPat,         FocusMethod::Weighted,
                                 FocusMethod::Eigenvector,   FocusMethod::LevenbergMarquardt};

FocusSettings with(FocusMethod method) {
  FocusSettings settings;
  settings.method = method;
  return settings;
}

/// Returns focal points about 200 mm above the array, each at least `apart` [m] from the others.
std::vector<Vec3> random_foci(Random& random, int count, double apart) {
  std::vector<Vec3> foci;
  while (static_cast<int>(foci.size()) < count) {
    // one after the other, so that no compiler changes their order
    const double z = random.uniform(0.15, 0.25), y = random.uniform(-0.06, 0.06),
                 x = random.uniform(-0.06, 0.06);
    const Vec3 p(x, y, z);
    bool far = true;
    for (const Vec3& other : foci) far = far && (p - other).norm() > apart;
    if (far) foci.push_back(p);
  }
  return foci;
}

Propagation propagation_to(const std::vector<Vec3>& foci) {
  return prostm::propagation_to(usx_array(), Medium{}, foci);
}

Eigen::VectorXd random_targets(Random& random, Eigen::Index count) {
  return Eigen::VectorXd::NullaryExpr(count, [&] { return random.uniform(0.25, 1.0); });
}

TEST(FocusSolver, OneFocusGetsTheTargetOrTheFullOutputOfTheArray) {
  const Propagation g = propagation_to({{0.02, -0.01, 0.2}});
  const double all = g.cwiseAbs().sum();
  for (const FocusMethod method : kMethods) {
    const auto low = solve_foci(g, Eigen::VectorXd::Constant(1, 10.0), with(method));
    EXPECT_NEAR(std::abs(low.pressure[0]), 10.0, 1e-9);
    EXPECT_NEAR(low.level, 1.0, 1e-12);
    const auto high = solve_foci(g, Eigen::VectorXd::Constant(1, 1e6), with(method));
    EXPECT_NEAR(high.drive.cwiseAbs().maxCoeff(), 1.0, 1e-12);
    EXPECT_LE(std::abs(high.pressure[0]), all * (1.0 + 1e-12));
    EXPECT_GT(std::abs(high.pressure[0]), 0.8 * all);
    EXPECT_NEAR(high.level * 1e6, std::abs(high.pressure[0]), 1e-6);
  }
  const auto phases = solve_foci(g, Eigen::VectorXd::Constant(1, 1e6), with(FocusMethod::Ibp));
  EXPECT_NEAR(std::abs(phases.pressure[0]), all, 1e-9 * all);
}

TEST(FocusSolver, DrivesStayWithinOneAndGiveTheReportedPressures) {
  Random random(1);
  for (std::uint64_t n = 0; n < test::reduced(200); ++n) {
    const Propagation g = propagation_to(random_foci(random, 1 + random.below(16), 5e-3));
    const Eigen::VectorXd target = random.uniform(1.0, 3000.0) * random_targets(random, g.rows());
    for (const FocusMethod method : kMethods) {
      const FocusSolution s = solve_foci(g, target, with(method));
      EXPECT_LE(s.drive.cwiseAbs().maxCoeff(), 1.0 + 1e-12);
      EXPECT_LT((g * s.drive - s.pressure).norm(), 1e-9 * s.pressure.norm());
      EXPECT_LE(s.level, 1.0 + 1e-12);
      EXPECT_GT(s.level, 0.0);
    }
  }
}

/// Means over random sets: the largest error of a focal point, and the power at full drive, i.e.
/// the sum of (level · a_m)² over that of each focal point alone.
struct Means {
  double worst = 0.0, power = 0.0;
};

Means means_of(FocusMethod method, int foci) {
  Random random(7);
  const auto sets = static_cast<int>(test::reduced(100));
  Means means;
  for (int n = 0; n < sets; ++n) {
    const Propagation g = propagation_to(random_foci(random, foci, 12e-3));
    const Eigen::VectorXd target = 1e6 * random_targets(random, foci);
    const FocusSolution s = solve_foci(g, target, with(method));
    means.worst += focus_errors(s, target).cwiseAbs().maxCoeff() / sets;
    const Eigen::ArrayXd alone = g.cwiseAbs().rowwise().sum();
    means.power += (s.level * target.array() / alone).square().sum() / sets;
  }
  return means;
}

TEST(FocusSolver, TheReferenceIsExactAndIterationsGainPower) {
  for (const int foci : {2, 4, 8}) {
    const Means added = means_of(FocusMethod::Superposition, foci);
    const Means gs_pat = means_of(FocusMethod::GsPat, foci);
    const Means ibp = means_of(FocusMethod::Ibp, foci);
    const Means eigenvector = means_of(FocusMethod::Eigenvector, foci);
    const Means reference = means_of(FocusMethod::LevenbergMarquardt, foci);
    EXPECT_LT(reference.worst, 1e-4) << foci;
    EXPECT_LT(eigenvector.worst, added.worst) << foci;
    EXPECT_GT(gs_pat.power, added.power) << foci;
    EXPECT_GT(ibp.power, gs_pat.power) << foci;
    EXPECT_GT(reference.power, 0.8 * ibp.power) << foci;
    std::printf(
        "%d foci, worst error and power: added %.3f %.3f, GS-PAT %.3f %.3f, IBP %.3f %.3f, "
        "eigenvector %.3f %.3f, reference %.1e %.3f\n",
        foci, added.worst, added.power, gs_pat.worst, gs_pat.power, ibp.worst, ibp.power,
        eigenvector.worst, eigenvector.power, reference.worst, reference.power);
  }
}

// (A4). Close to the array, focal points far apart each get more than 1/P of a single one's power.
TEST(FocusSolver, DistantFocalPointsGetMoreThanEqualShares) {
  const auto bound_and_power = [](double height) {
    std::vector<Vec3> corners;
    for (const double x : {-0.06, 0.06}) {
      for (const double y : {-0.06, 0.06}) corners.emplace_back(x, y, height);
    }
    const Propagation g = propagation_to(corners);
    const Eigen::ArrayXd alone = g.cwiseAbs().rowwise().sum();
    const double spread =
        (static_cast<double>(g.cols()) * g.cwiseAbs2().rowwise().sum().array() / alone.square())
            .maxCoeff();
    const FocusSolution s = solve_foci(g, Eigen::VectorXd::Constant(4, 1e6), {});
    return std::pair(spread, (s.pressure.cwiseAbs().array() / alone).square().sum());
  };
  const auto [bound_low, low] = bound_and_power(0.06);
  const auto [bound_high, high] = bound_and_power(0.2);
  std::printf("of 4 focal points: %.3f of at most %.3f at 60 mm, %.3f of %.3f at 200 mm\n", low,
              bound_low, high, bound_high);
  EXPECT_GT(low, 1.2);
  EXPECT_LT(low, bound_low);
  EXPECT_LT(high, bound_high);
  EXPECT_LT(bound_high, 1.1);
}

TEST(FocusSolver, HalfTheTargetRadiationPressureGivesHalf) {
  Random random(3);
  const Propagation g = propagation_to(random_foci(random, 4, 15e-3));
  const Eigen::VectorXd target = 50.0 * random_targets(random, 4);
  for (const FocusMethod method : kMethods) {
    const FocusSolution whole = solve_foci(g, target, with(method));
    const FocusSolution half = solve_foci(g, std::sqrt(0.5) * target, with(method));
    for (Eigen::Index m = 0; m < 4; ++m) {
      EXPECT_NEAR(std::norm(half.pressure[m]), 0.5 * std::norm(whole.pressure[m]),
                  1e-6 * std::norm(whole.pressure[m]));
    }
  }
}

TEST(FocusSolver, UnitsAndTheOrderOfFocalPointsDoNotMatter) {
  Random random(4);
  const std::vector<Vec3> foci = random_foci(random, 5, 12e-3);
  const Propagation g = propagation_to(foci), reversed = g.colwise().reverse();
  const Eigen::VectorXd target = 100.0 * random_targets(random, 5);
  for (const FocusMethod method : kMethods) {
    const FocusSolution s = solve_foci(g, target, with(method));
    const FocusSolution in_kpa = solve_foci(1e-3 * g, 1e-3 * target, with(method));
    EXPECT_LT((in_kpa.drive - s.drive).norm(), 1e-6 * s.drive.norm());
    const FocusSolution other = solve_foci(reversed, target.reverse(), with(method));
    EXPECT_LT((other.drive - s.drive).norm(), 1e-6 * s.drive.norm());
  }
}

TEST(FocusSolver, AnyTargetIsReachedOrSharedOut) {
  const Propagation g = propagation_to({{0.02, 0.0, 0.2}, {-0.02, 0.0, 0.2}, {0.0, 0.03, 0.2}});
  for (const FocusMethod method : kMethods) {
    for (const double pressure : {1e-200, 1e-9, 1.0, 1e200}) {
      const Eigen::Vector3d target(pressure, 0.0, 0.5 * pressure);
      const FocusSolution s = solve_foci(g, target, with(method));
      EXPECT_GT(s.level, 0.0);
      EXPECT_LE(s.level, 1.0);
      EXPECT_LE(s.drive.cwiseAbs().maxCoeff(), 1.0 + 1e-12);
      EXPECT_LT(focus_errors(s, target).cwiseAbs().maxCoeff(), 0.5);
    }
  }
}

TEST(FocusSolver, FocalPointsThatCancelGetNothing) {
  const Propagation one = propagation_to({{0.0, 0.0, 0.2}});
  Propagation g(2, one.cols());
  g << one, one;
  const FocusSolution s = solve_foci(g, Eigen::Vector2d(10.0, 10.0),
                                     with(FocusMethod::Superposition), Eigen::Vector2d(0.0, kPi));
  EXPECT_LE(s.drive.cwiseAbs().maxCoeff(), 1.0);
  EXPECT_TRUE(std::isfinite(s.level));
}

TEST(FocusSolver, StartsFromThePhasesOfThePreviousSolution) {
  // the phases are already near a fixed point, so the drives hardly change
  Random random(5);
  std::vector<Vec3> foci = random_foci(random, 4, 15e-3);
  const Eigen::VectorXd target = 100.0 * random_targets(random, 4);
  const FocusSolution before = solve_foci(propagation_to(foci), target, with(FocusMethod::GsPat));
  for (Vec3& p : foci) p.x() += 0.175e-3;  // 7 m/s at 40 kHz
  const Propagation g = propagation_to(foci);
  const Eigen::VectorXd phases =
      before.pressure.unaryExpr([](const auto& p) { return std::arg(p); });
  // compared over all drives, since the phase of a weak drive is poorly determined
  const auto moved = [&](const FocusSolution& s) {
    return (s.drive - before.drive).norm() / before.drive.norm();
  };
  EXPECT_LT(moved(solve_foci(g, target, with(FocusMethod::GsPat), phases)), 0.2);
  // from other phases the drives change
  const Eigen::VectorXd others = phases + Eigen::Vector4d(0.0, 2.0, -2.0, 3.0);
  EXPECT_GT(moved(solve_foci(g, target, with(FocusMethod::GsPat), others)), 0.4);
}

TEST(FocusSolver, RejectsInvalidArguments) {
  const Propagation g = propagation_to({{0.0, 0.0, 0.2}, {0.02, 0.0, 0.2}});
  const Eigen::VectorXd good = Eigen::VectorXd::Constant(2, 10.0);
  const auto refuses = [&](const Propagation& matrix, const Eigen::VectorXd& target,
                           const Eigen::VectorXd& start, const FocusSettings& settings) {
    EXPECT_THROW(solve_foci(matrix, target, settings, start), std::invalid_argument);
  };
  refuses(Propagation(0, 256), Eigen::VectorXd(), {}, {});
  refuses(Propagation(2, 0), good, {}, {});
  refuses(g, Eigen::VectorXd::Constant(3, 1.0), {}, {});
  refuses(g, good, Eigen::VectorXd::Zero(1), {});
  refuses(g, Eigen::Vector2d(1.0, -1.0), {}, {});
  refuses(g, Eigen::Vector2d(1.0, std::numeric_limits<double>::quiet_NaN()), {}, {});
  refuses(g, Eigen::VectorXd::Zero(2), {}, {});
  Propagation silent = g;
  silent.row(1).setZero();
  refuses(silent, good, {}, {});
  silent(1, 0) = std::numeric_limits<double>::infinity();
  refuses(silent, good, {}, {});
  FocusSettings settings;
  settings.iterations = 0;
  refuses(g, good, {}, settings);
}

TEST(Propagation, RejectsInvalidFocalPoints) {
  const TransducerArray array = usx_array();
  const auto refuses = [&](std::vector<Vec3> foci, const char* word) {
    try {
      prostm::propagation_to(array, Medium{}, foci);
      FAIL() << word;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  };
  refuses({}, "0 focal points");
  refuses(std::vector<Vec3>(1000, Vec3(0, 0, 0.2)), "1000 focal points");
  refuses({{0, 0, -0.2}}, "behind the array");
  refuses({{0, 0, 0.2}, {5.25e-3, 5.25e-3, 1e-3}}, "focal point 2 is on transducer");
  refuses({{0, 0, 0.2}, {0.02, 0, 0.2}, {0, 0, 0.2}}, "at the position of focal point 1");
  refuses({{0, std::numeric_limits<double>::quiet_NaN(), 0.2}}, "finite");
}

TEST(FocusSolver, CoincidingFocalPointsCountAsOne) {
  const Propagation one = propagation_to({{0.0, 0.0, 0.2}});
  Propagation g(2, one.cols());
  g << one, one;
  for (const FocusMethod method : kMethods) {
    const FocusSolution s = solve_foci(g, Eigen::Vector2d(10.0, 10.0), with(method));
    EXPECT_NEAR(std::abs(s.pressure[0]), 10.0, 1e-6);
    EXPECT_NEAR(std::abs(s.pressure[1]), 10.0, 1e-6);
  }
}

}  // namespace
}  // namespace prostm
