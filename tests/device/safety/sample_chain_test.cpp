#include "prostm/device/safety/sample_chain.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "prostm/core/random.hpp"
#include "support/heap_guard.hpp"

namespace prostm {
namespace {

/// A source whose samples come from a function of sample and focal point.
class Made final : public SampleSource {
 public:
  Made(int foci, FocusSample (*make)(std::int64_t, int)) : foci_(foci), make_(make) {}
  int foci() const override { return foci_; }
  void fill(std::int64_t first, std::span<FocusSample> out) noexcept override {
    for (std::size_t i = 0; i < out.size(); ++i) {
      const auto at = static_cast<std::int64_t>(i);
      out[i] = make_(first + at / foci_, static_cast<int>(at % foci_));
    }
  }

 private:
  int foci_;
  FocusSample (*make_)(std::int64_t, int);
};

/// Like an emission: smooth, and within its power limit. It rises so slowly that no ramp is
/// needed.
FocusSample smooth(std::int64_t sample, int focus) {
  const auto t = static_cast<double>(sample);
  const double intensity = 0.5 * (1.0 + focus % 2) * (1.0 - std::cos(0.04 * t + focus)) / 2.0;
  return {Eigen::Vector3f(static_cast<float>(1e-4 * t), static_cast<float>(focus), 0.2F),
          static_cast<float>(sample < 4000 ? intensity * t * t / 16e6 : intensity)};
}

std::vector<FocusSample> filled(SampleSource& source, std::int64_t samples, std::int64_t block) {
  std::vector<FocusSample> out(static_cast<std::size_t>(samples * source.foci()));
  for (std::int64_t first = 0; first < samples; first += block) {
    const std::int64_t n = std::min(block, samples - first);
    source.fill(first, std::span(out).subspan(static_cast<std::size_t>(first * source.foci()),
                                              static_cast<std::size_t>(n * source.foci())));
  }
  return out;
}

bool same(const FocusSample& a, const FocusSample& b) {
  return a.p_D == b.p_D && a.intensity == b.intensity;
}

TEST(SampleChain, PassesAnEmissionUnchanged) {
  Made source(4, smooth);
  SampleChain chain(source, {});
  const std::vector<FocusSample> given = filled(source, 8000, 40), out = filled(chain, 8000, 40);
  for (std::size_t i = 0; i < given.size(); ++i) ASSERT_TRUE(same(given[i], out[i])) << i;
  EXPECT_EQ(chain.limited() + chain.safety().ramp, 0);
}

TEST(SampleChain, DecimatesForAnyBlocks) {
  Made source(3, smooth);
  DeviceInfo device;
  device.decimation = 7;
  device.intensity_per_focus = true;
  const auto chain = make_sample_chain(source, device, {});
  const std::vector<FocusSample> out = filled(*chain, 500, 130);
  for (std::int64_t i = 0; i < 500; ++i) {
    for (int f = 0; f < 3; ++f) {
      ASSERT_TRUE(same(out[static_cast<std::size_t>(3 * i + f)], smooth(7 * i, f))) << i;
    }
  }
  EXPECT_EQ(chain->limited(), 0) << "the allowed change grows with the decimation";
}

/// Like AM foci: the intensity rises and falls, and the focal point jumps where it is 0.
FocusSample jumping(std::int64_t sample, int focus) {
  const std::int64_t period = 200 + focus;
  const double phase = static_cast<double>(sample % period) / static_cast<double>(period);
  return {Eigen::Vector3f(0.02F * static_cast<float>(sample / period % 5), 0.0F, 0.2F),
          static_cast<float>(std::sin(std::numbers::pi * phase))};
}

TEST(SampleChain, IsSilentAtAJumpWhoseSilentSampleIsDropped) {
  for (const int factor : {1, 2, 3, 4, 6, 7, 13}) {
    for (const bool own : {true, false}) {
      Made source(2, jumping);
      DeviceInfo device;
      device.decimation = factor;
      device.intensity_per_focus = own;
      const auto chain = make_sample_chain(source, device, {});
      const std::vector<FocusSample> out = filled(*chain, 20'000 / factor, 130);
      double given = 0.0, passed = 0.0;
      for (std::size_t i = 2; i < out.size(); ++i) {
        ASSERT_LE(std::abs(out[i].intensity - out[i - 2].intensity),
                  0.0251F * static_cast<float>(factor));
        given += static_cast<double>(
            jumping(static_cast<std::int64_t>(i / 2) * factor, static_cast<int>(i % 2)).intensity);
        passed += static_cast<double>(out[i].intensity);
        if (out[i].p_D == out[i - 2].p_D) continue;
        ASSERT_EQ(std::min(out[i].intensity, out[i - 2].intensity), 0.0F) << factor << " " << i;
      }
      EXPECT_GT(passed, (own ? 0.95 : 0.9) * given) << factor << ": mutes too much";
    }
  }
}

TEST(SampleChain, SharesTheLargestIntensity) {
  Made source(4, smooth);
  DeviceInfo device;  // one intensity for all
  const auto chain = make_sample_chain(source, device, {});
  const std::vector<FocusSample> out = filled(*chain, 300, 40);
  for (std::size_t i = 0; i < out.size(); i += 4) {
    float largest = 0.0F;
    for (int f = 0; f < 4; ++f)
      largest = std::max(largest, smooth(static_cast<std::int64_t>(i / 4), f).intensity);
    for (std::size_t f = 0; f < 4; ++f) EXPECT_EQ(out[i + f].intensity, largest);
  }
}

TEST(SampleChain, TheLimiterStaysLast) {
  Made source(2, [](std::int64_t sample, int) {
    return FocusSample{Eigen::Vector3f::Zero(), sample < 10 ? 0.0F : 1.0F};
  });
  SampleChain chain(source, {});
  SampleTap& before = chain.add<SampleTap>(8000);
  chain.add<SharedIntensity>();
  const std::vector<FocusSample> out = filled(chain, 3000, 40);
  FocusSample seen;
  for (std::size_t i = 0; i < out.size(); ++i) {
    ASSERT_TRUE(before.next(seen));
    EXPECT_EQ(seen.intensity, i < 20 ? 0.0F : 1.0F) << "unchanged from the source";
    if (i >= 2) {
      EXPECT_LE(out[i].intensity - out[i - 2].intensity, 0.0251F);
    }
  }
  EXPECT_FALSE(before.next(seen));
  EXPECT_EQ(out.back().intensity, 1.0F);
  EXPECT_EQ(chain.limited(), 2) << "each focal point jumped once";
}

TEST(SampleChain, AFullTapDropsAndCountsSamples) {
  Made source(1, smooth);
  SampleChain chain(source, {});
  SampleTap& tap = chain.add<SampleTap>(30);
  filled(chain, 100, 40);
  EXPECT_EQ(tap.lost(), 70);
  FocusSample oldest;
  ASSERT_TRUE(tap.next(oldest));
  EXPECT_TRUE(same(oldest, smooth(0, 0)));
}

TEST(SafetyLimiter, NoStageCanExceedTheLimits) {
  static Random random(7);
  Made wild(4, [](std::int64_t, int) {
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInf = std::numeric_limits<float>::infinity();
    FocusSample s{Eigen::Vector3f::Constant(static_cast<float>(random.uniform(-1, 1))),
                  static_cast<float>(random.uniform(-3, 3))};
    const double luck = random.uniform(0, 1);
    if (luck < 0.05) s.intensity = kNaN;
    if (luck > 0.95) s.intensity = kInf;
    if (luck > 0.4 && luck < 0.45) s.p_D.y() = kNaN;
    if (luck > 0.5 && luck < 0.55) s.p_D.z() = -kInf;
    return s;
  });
  SampleChain chain(wild, {.power = 1.5});
  std::vector<FocusSample> out(4 * 40);
  std::vector<float> last(4, 0.0F);
  for (std::int64_t block = 0; block < 2500; ++block) {
    {
      const test::HeapGuard guard;
      chain.fill(40 * block, out);
      ASSERT_EQ(guard.allocations(), 0U);
    }
    for (std::size_t i = 0; i < out.size(); i += 4) {
      double power = 0.0;
      for (std::size_t f = 0; f < 4; ++f) {
        const float now = out[i + f].intensity;
        ASSERT_LE(out[i + f].p_D.cwiseAbs().maxCoeff(), 1.0F);
        ASSERT_TRUE(now >= 0.0F && now <= 1.0F);
        ASSERT_LE(now - last[f], 0.0251F) << "rises";
        power += static_cast<double>(now) * static_cast<double>(now);
        last[f] = now;
      }
      ASSERT_LE(power, 1.5 * 1.001);
    }
  }
}

}  // namespace
}  // namespace prostm
