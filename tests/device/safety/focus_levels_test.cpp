// Levels that an array can reach: the table of the limiter, and the level at the head.
#include "prostm/device/safety/focus_levels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "prostm/acoustics/focus/array_output.hpp"
#include "prostm/core/random.hpp"
#include "prostm/device/safety/head_levels.hpp"
#include "prostm/device/safety/safety_limiter.hpp"
#include "support/load.hpp"

namespace prostm {
namespace {

/// Two units side by side, tilted towards each other.
TransducerArray two_units() {
  const auto turned = [](double x, double angle) {
    Pose X = Pose::Identity();
    X.translation() = Vec3(x, 0.0, 0.0);
    X.linear() = Eigen::AngleAxisd(angle, Vec3::UnitY()).toRotationMatrix();
    return place(autd3_array(), X);
  };
  const TransducerArray units[] = {turned(-0.1, 0.35), turned(0.1, -0.35)};
  return join(units);
}

Eigen::Vector3f place_in(const Eigen::AlignedBox3d& box, Random& random) {
  Vec3 p;
  for (int axis = 0; axis < 3; ++axis) p[axis] = random.uniform(box.min()[axis], box.max()[axis]);
  return p.cast<float>();
}

double nearest(const TransducerArray& array, const Vec3& p) {
  double least = 1.0;
  for (const Vec3& at : array.position) least = std::min(least, (p - at).norm());
  return least;
}

TEST(FocusLevels, AreNeverBelowTheExactValueAndHardlyAboveIt) {
  struct Case {
    TransducerArray array;
    std::uint64_t points;
  };
  for (const Case& c :
       {Case{usx_array(), 30'000}, Case{autd3_array(), 60'000}, Case{two_units(), 20'000}}) {
    SCOPED_TRACE(c.array.name);
    const FocusLevels levels(c.array);
    Random random(3);
    std::vector<double> excess;
    for (std::uint64_t i = 0; i < test::reduced(c.points); ++i) {
      const Eigen::Vector3f p = place_in(levels.box(), random);
      ASSERT_TRUE(levels.holds(p));
      if (nearest(c.array, p.cast<double>()) < 20e-3) continue;
      const double truth = full_pressure(c.array, p.cast<double>());
      const double table = static_cast<double>(levels.pressure(p));
      ASSERT_GE(table, truth) << p.transpose();
      if (p.z() > 0.1F) excess.push_back(table / truth - 1.0);
    }
    std::sort(excess.begin(), excess.end());
    const double half = excess[excess.size() / 2], most = excess.back();
    std::printf("%s: over the truth by %.1f %% in the median, %.1f %% at most above 100 mm\n",
                c.array.name.c_str(), 100.0 * half, 100.0 * most);
    EXPECT_LT(half, 0.03);
    EXPECT_LT(most, 0.15);
  }
}

TEST(FocusLevels, CoversOnlyPositionsInItsTable) {
  const FocusLevels levels(usx_array());
  EXPECT_TRUE(levels.holds({0.0F, 0.0F, 0.2F}));
  EXPECT_FALSE(levels.holds({0.0F, 0.0F, 0.01F}));
  EXPECT_FALSE(levels.holds({0.0F, 0.0F, -0.2F}));
  EXPECT_FALSE(levels.holds({0.0F, 0.0F, 0.6F}));
  EXPECT_FALSE(levels.holds({0.3F, 0.0F, 0.2F}));
}

TEST(FocusLevels, UsesTheLargestAmplitudeOfTheSources) {
  TransducerArray array = usx_array();
  EXPECT_EQ(largest_amplitude(array), 8.02);
  EXPECT_EQ(smallest_amplitude(array), 1.09624833) << "measured, below all sources";
  EXPECT_EQ(largest_amplitude(autd3_array()), 8.02);
  EXPECT_EQ(smallest_amplitude(autd3_array()), 2.53);
  array.amplitude_high = 12.0;
  EXPECT_EQ(largest_amplitude(array), 12.0);
}

/// The largest pressure of an array at a focal point is that of the simulated array with the
/// largest amplitude and without losses. No output of a solver may exceed the bound.
TEST(FocusLevels, BoundTheOutputOfSolvers) {
  TransducerArray array = usx_array();
  array.amplitude = array.amplitude_high = largest_amplitude(array);
  const Medium medium;
  const SafetyLevels levels(array, medium, 0.5);
  const Wave sound = wave(array, medium);
  Random random(5);
  double nearest_to_bound = 0.0;
  for (const FocusMethod method : {FocusMethod::Weighted, FocusMethod::Superposition}) {
    for (const double full_scale : {0.0, static_cast<double>(levels.full_scale)}) {
      ArrayOutputSettings settings;
      settings.solver.method = method;
      settings.solver.full_scale = full_scale;
      settings.transducer.memoryless = true;
      ArrayOutput output(array, medium, settings);
      for (int trial = 0; trial < 500; ++trial) {
        std::vector<LiveFocus> foci(static_cast<std::size_t>(1 + random.below(4)));
        float sum = 0.0F, stretch = 1.0F, most = 0.0F;
        for (LiveFocus& focus : foci) {
          focus.p_D = Eigen::Vector3f(static_cast<float>(random.uniform(-0.08, 0.08)),
                                      static_cast<float>(random.uniform(-0.08, 0.08)),
                                      static_cast<float>(random.uniform(0.1, 0.4)));
          focus.amplitude = static_cast<float>(random.uniform(0.02, 1.0));
          sum += focus.amplitude;
          const float full = levels.focus.pressure(focus.p_D);
          stretch = std::max(stretch, levels.full_scale / full);
          most = std::max(most, full);
        }
        output.reset();
        for (int k = 0; k < 20; ++k) output.step(foci);
        const auto bound = static_cast<double>(std::min(1.0F, sum * stretch) * most);
        for (const LiveFocus& focus : foci) {
          std::complex<double> p = 0.0;
          for (std::size_t i = 0; i < array.position.size(); ++i)
            p += output.envelopes()[i] * propagate(array, sound, i, focus.p_D.cast<double>());
          ASSERT_LE(std::abs(p), bound * (1.0 + 1e-5)) << foci.size();
          nearest_to_bound = std::max(nearest_to_bound, std::abs(p) / bound);
        }
      }
    }
  }
  std::printf("the loudest was at %.2f of its bound\n", nearest_to_bound);
  EXPECT_GT(nearest_to_bound, 0.9) << "the bound is tight";
}

TEST(HeadLevel, IsAnIntervalThatDecreasesWithDistance) {
  for (const TransducerArray& array : {usx_array(), autd3_array()}) {
    double before = 1000.0;
    for (const double distance : kHeadDistances) {
      const HeadLevel level = head_level(array, distance);
      EXPECT_LT(level.low, level.likely);
      EXPECT_LT(level.likely, level.estimate);
      EXPECT_LT(level.estimate, level.bound);
      EXPECT_LT(level.estimate, before);
      before = level.estimate;
    }
  }
  // by hand: 256 sources of 8.02 Pa·m at 1 m are 136 dB if incoherent, 166 dB coherent and doubled
  const HeadLevel far = head_level(usx_array(), 1.0);
  EXPECT_NEAR(far.bound, 20.0 * std::log10(2.0 * 256.0 * 8.02 / 20e-6), 0.2);
  EXPECT_NEAR(far.estimate, 136.1 + 1.1, 0.4);
  // with the measured amplitude, and what 1 m of air absorbs
  const double absorbed = 20.0 * std::log10(std::exp(1.0)) * wave(usx_array(), {}).absorption;
  EXPECT_GT(absorbed, 0.5);
  EXPECT_NEAR(far.low, 20.0 * std::log10(16.0 * 1.09625 / 20e-6) - absorbed, 0.2);
}

TEST(HeadLevel, RecommendedCapsKeepTheConsensusAtTheEar) {
  for (const TransducerArray& array : {usx_array(), autd3_array()}) {
    const HeadLevel head = head_level(array, 0.5);
    for (const RecommendedLevel& of : recommended_levels(head)) {
      EXPECT_LE(of.level - of.protection, 110.0) << of.use;
      EXPECT_NEAR(of.cost, 2.0 * (head.likely - of.level), 1e-9);
      EXPECT_LE(of.cap, 145.0);
    }
  }
  const auto [study, demo] = recommended_levels(head_level(usx_array(), 0.5));
  EXPECT_EQ(study.cost, 0.0) << "with hearing protection the full output may be used";
  EXPECT_GT(demo.cost, 20.0);
}

TEST(FocusLevels, TheLikelyPressureIsTheMeasuredOne) {
  const TransducerArray array = usx_array();
  const Vec3 focus(0.0, 0.0, 0.2);  // 155 dB were measured there
  const double likely = absorbed_pressure(array, focus, likely_amplitude(array));
  EXPECT_NEAR(20.0 * std::log10(likely / 20e-6), 155.0, 0.1);
  EXPECT_LE(absorbed_pressure(array, focus, smallest_amplitude(array)), likely);
  EXPECT_LT(likely, full_pressure(array, focus));
  EXPECT_EQ(likely_amplitude(autd3_array()), autd3_array().amplitude) << "none was measured";
}

TEST(HeadLevel, LimitsAreSortedAndNameTheirSources) {
  double before = 0.0;
  for (const ExposureLimit& limit : exposure_limits()) {
    EXPECT_GE(limit.level, before);
    before = limit.level;
    EXPECT_FALSE(std::string(limit.source).empty());
  }
}

}  // namespace
}  // namespace prostm
