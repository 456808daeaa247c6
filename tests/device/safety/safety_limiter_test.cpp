// The last stage before a device: caps hold for any input, and input within the caps passes
// unchanged.
#include "prostm/device/safety/safety_limiter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "prostm/core/random.hpp"
#include "prostm/device/safety/sample_chain.hpp"
#include "prostm/emit/emitter.hpp"
#include "support/heap_guard.hpp"
#include "support/load.hpp"

namespace prostm {
namespace {

using Samples = std::vector<FocusSample>;

/// Plays what it is given, one block at a time.
class Given final : public SampleSource {
 public:
  explicit Given(int foci) : foci_(foci) {}
  int foci() const override { return foci_; }
  void fill(std::int64_t, std::span<FocusSample> out) noexcept override {
    std::copy_n(next.begin(), out.size(), out.begin());
  }
  Samples next;

 private:
  int foci_;
};

/// A small array, so that exact sums are cheap, with the output of 256 of the usual transducers.
TransducerArray small_array() {
  TransducerArray array = usx_array();
  array.position.clear();
  array.normal.clear();
  for (int i = 0; i < 36; ++i) {
    array.position.emplace_back(0.028 * (i % 6 - 2.5), 0.028 * (i / 6 - 2.5), 0.0);
    array.normal.push_back(Vec3::UnitZ());
  }
  array.amplitude_high = 57.0;
  return array;
}

struct Caps {
  SafetySettings caps;
  std::shared_ptr<const SafetyLevels> levels;
};

Caps random_caps(const TransducerArray& array, Random& random) {
  SafetySettings caps;
  caps.intensity = random.uniform(0.2, 1.0);
  caps.power = random.uniform(0.2, 4.0);
  caps.acoustic_pressure = random.uniform(1e3, 12e3);
  caps.radiation_pressure = random.uniform(50.0, 2e3);
  caps.mean_radiation_pressure = random.uniform(20.0, 1.5e3);
  caps.head_level = random.uniform(125.0, 145.0);
  return {caps, std::make_shared<const SafetyLevels>(array, Medium{}, caps.head_distance)};
}

/// Checks samples one after another, with an independent computation of the levels.
class Judge {
 public:
  Judge(const TransducerArray& array, const Caps& caps, double rate)
      : array_(array), caps_(caps), rate_(rate) {}

  /// Checks a sample of all focal points. @param exact whether to compute the exact sum.
  void look(std::span<const FocusSample> sample, bool exact) {
    const SafetySettings& cap = caps_.caps;
    double sum = 0.0, power = 0.0, loudest = 0.0, truth = 0.0;
    bool known = true;
    last_.resize(sample.size(), 0.0);
    place_.resize(sample.size(), Eigen::Vector3f::Zero());
    for (std::size_t f = 0; f < sample.size(); ++f) {
      const double intensity = static_cast<double>(sample[f].intensity);
      finite = finite && std::isfinite(intensity) &&
               std::all_of(sample[f].p_D.begin(), sample[f].p_D.end(),
                           [](float x) { return std::isfinite(x); });
      if (!finite) return;
      change = std::max(change, std::abs(intensity - last_[f]));
      if (std::min(intensity, last_[f]) > 0.0)
        step = std::max(step, static_cast<double>((sample[f].p_D - place_[f]).norm()));
      last_[f] = intensity;
      place_[f] = sample[f].p_D;
      in_range = in_range && intensity >= 0.0 && intensity <= cap.intensity * 1.0001;
      power += intensity * intensity;
      if (intensity <= 0.0) continue;
      if (!caps_.levels->focus.holds(sample[f].p_D)) {
        known = false;
        continue;
      }
      sum += intensity;
      loudest = std::max(loudest, static_cast<double>(caps_.levels->focus.pressure(sample[f].p_D)));
      if (exact) truth = std::max(truth, full_pressure(array_, sample[f].p_D.cast<double>()));
    }
    in_place = in_place && known;
    most_power = std::max(most_power, power / cap.power);
    // for a device that takes intensity as a drive, and for one that takes it as a pressure
    const double scale = static_cast<double>(caps_.levels->full_scale);
    const auto made = [&](double full) {
      return std::max(std::min(1.0, sum) * full, std::min(full, sum * scale));
    };
    if (exact) most_exact = std::max(most_exact, made(truth) / cap.acoustic_pressure);
    const double pressure = made(loudest);
    most_pressure = std::max(most_pressure, pressure / cap.acoustic_pressure);
    const double radiation = radiation_pressure(pressure, Medium{});
    most_radiation = std::max(most_radiation, radiation / cap.radiation_pressure);
    const double drive = loudest > 0.0 ? pressure / loudest : 0.0;
    add(radiation, drive * drive);
  }

  bool finite = true, in_range = true, in_place = true;
  double change = 0.0, step = 0.0, most_power = 0.0, most_exact = 0.0, most_pressure = 0.0,
         most_radiation = 0.0;  // relative to their caps
  double most_mean = 0.0, most_head = 0.0;

  bool keeps_caps() const {
    return finite && in_range && in_place && most_power < 1.001 && most_exact < 1.001 &&
           most_pressure < 1.001 && most_radiation < 1.001 && most_mean < 1.001 &&
           most_head < 1.001;
  }

 private:
  /// Adds the sums over each second, as differences of running sums.
  void add(double radiation, double energy) {
    const auto second = static_cast<std::size_t>(rate_);
    sums_.push_back({(sums_.empty() ? 0.0 : sums_.back().first) + radiation,
                     (sums_.empty() ? 0.0 : sums_.back().second) + energy});
    const std::size_t n = sums_.size();
    const auto before = n > second ? sums_[n - 1 - second] : std::pair<double, double>{0.0, 0.0};
    most_mean = std::max(most_mean, (sums_.back().first - before.first) / rate_ /
                                        caps_.caps.mean_radiation_pressure);
    const double head_cap =
        std::pow(10.0, 0.1 * (caps_.caps.head_level - caps_.levels->head.estimate));
    most_head = std::max(most_head, (sums_.back().second - before.second) / rate_ / head_cap);
  }

  const TransducerArray& array_;
  const Caps& caps_;
  const double rate_;
  std::vector<double> last_;
  std::vector<Eigen::Vector3f> place_;
  std::vector<std::pair<double, double>> sums_;
};

/// A stream of a random kind: noise, jumps, walks, full output, with occasional faults.
class RandomStream {
 public:
  RandomStream(Random& random, std::size_t foci) : random_(random), state_(foci) { begin(); }

  void begin() {
    kind_ = random_.below(5);
    loud_ = random_.uniform() < 0.7;
    for (FocusSample& s : state_) s = {somewhere(), static_cast<float>(random_.uniform(0.0, 1.2))};
  }
  void next(std::span<FocusSample> out) {
    for (std::size_t f = 0; f < out.size(); ++f) {
      FocusSample& s = state_[f];
      if (kind_ == 0) s = {somewhere(), static_cast<float>(random_.uniform(-1.0, 3.0))};
      if (kind_ == 1 && random_.uniform() < 0.02) s.p_D = somewhere();
      if (kind_ == 2) s.p_D += Eigen::Vector3f(step(), step(), step());
      if (kind_ == 3) s.intensity = std::clamp(s.intensity + 100.0F * step(), 0.0F, 1.0F);
      if (kind_ >= 1 && kind_ != 3) s.intensity = loud_ ? 1.0F : s.intensity;
      out[f] = s;
      fault(out[f]);
    }
  }

 private:
  float step() { return static_cast<float>(random_.uniform(-2e-4, 2e-4)); }
  Eigen::Vector3f somewhere() {
    return {static_cast<float>(random_.uniform(-0.1, 0.1)),
            static_cast<float>(random_.uniform(-0.1, 0.1)),
            static_cast<float>(random_.uniform(-0.02, 0.4))};
  }
  void fault(FocusSample& s) {
    if (random_.bits() % 512 != 0) return;
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInf = std::numeric_limits<float>::infinity();
    const int which = random_.below(4);
    if (which == 0) s.intensity = kNaN;
    if (which == 1) s.p_D.y() = kNaN;
    if (which == 2) s.p_D.z() = -kInf;
    if (which == 3) s.intensity = kInf;
  }
  Random& random_;
  Samples state_;
  int kind_ = 0;
  bool loud_ = true;
};

TEST(SafetyLimiter, CapsHoldFor100000RandomStreams) {
  constexpr std::size_t kFoci = 4, kLength = 20;
  constexpr int kCaps = 20, kStreams = static_cast<int>(test::reduced(5000));
  const TransducerArray array = small_array();
  Random random(11);
  int exceeded = 0;
  for (int c = 0; c < kCaps; ++c) {
    const Caps caps = random_caps(array, random);
    Given given(kFoci);
    SampleChain chain(given, {.caps = caps.caps, .levels = caps.levels});
    RandomStream stream(random, kFoci);
    Judge judge(array, caps, 40e3), raw(array, caps, 40e3);
    given.next.resize(kFoci * kLength);
    Samples out(given.next.size());
    for (int s = 0; s < kStreams; ++s) {
      stream.begin();
      for (std::size_t i = 0; i < given.next.size(); i += kFoci)
        stream.next(std::span(given.next).subspan(i, kFoci));
      {
        const test::HeapGuard guard;
        chain.fill(0, out);
        ASSERT_EQ(guard.allocations(), 0U);
      }
      for (std::size_t i = 0; i < out.size(); i += kFoci) {
        judge.look(std::span(out).subspan(i, kFoci), i / kFoci == kLength / 2);
        raw.look(std::span(given.next).subspan(i, kFoci), false);
      }
    }
    ASSERT_TRUE(judge.keeps_caps())
        << judge.finite << judge.in_range << judge.in_place << " power " << judge.most_power
        << " exact " << judge.most_exact << " pressure " << judge.most_pressure << " radiation "
        << judge.most_radiation << " mean " << judge.most_mean << " head " << judge.most_head;
    ASSERT_LE(judge.change, 0.025 * 1.001);
    ASSERT_LE(judge.step, 8.0 / 40e3 * 1.002);
    exceeded += raw.keeps_caps() ? 0 : 1;
  }
  EXPECT_EQ(exceeded, kCaps) << "every set of streams needs the limiter";
}

/// Up to four paths near and far, some of them off to the side of the array.
void random_plan(Random& random, LiftedPlan& plan) {
  plan.paths.clear();
  ++plan.id;
  const int paths = 1 + random.below(4);
  for (int k = 0; k < paths; ++k) {
    LiftedPath& path = plan.paths.emplace_back();
    const Vec3 centre(random.uniform(-0.12, 0.12), random.uniform(-0.12, 0.12),
                      random.uniform(0.01, 0.4));
    const double radius = random.uniform(0.0, 0.03);
    for (int i = 0; i < 8; ++i) {
      const double angle = 2.0 * kPi * i / 8.0;
      path.p_D.push_back(centre + radius * Vec3(std::cos(angle), std::sin(angle), 0.0));
      path.pressure.push_back(random.uniform(0.0, 2.0));
    }
    path.speed = 7.0;
  }
}

TEST(SafetyLimiter, CapsHoldFor100000RandomPlans) {
  constexpr std::size_t kFoci = 4, kBlock = 10;
  constexpr int kCaps = 20, kPlans = static_cast<int>(test::reduced(5000));
  const TransducerArray array = small_array();
  Random random(13);
  int exceeded = 0;
  for (int c = 0; c < kCaps; ++c) {
    const Caps caps = random_caps(array, random);
    EmitSettings settings;
    settings.full_scale_pressure = 1.0;
    settings.switch_at = SwitchAt::Now;
    const auto emitter = make_emitter(Method::ProStm, settings, 40e3);
    SampleChain chain(*emitter, {.caps = caps.caps, .levels = caps.levels});
    SampleTap& tap = chain.add<SampleTap>(2 * kFoci * kBlock);
    Judge judge(array, caps, 40e3), raw(array, caps, 40e3);
    Samples out(kFoci * kBlock), before(kFoci);
    for (int p = 0; p < kPlans; ++p) {
      random_plan(random, emitter->draft());
      emitter->submit();
      chain.fill(std::int64_t{p} * static_cast<std::int64_t>(kBlock), out);
      for (std::size_t i = 0; i < out.size(); i += kFoci) {
        for (FocusSample& s : before) ASSERT_TRUE(tap.next(s));
        judge.look(std::span(out).subspan(i, kFoci), p % 8 == 0 && i == 0);
        raw.look(before, false);
      }
    }
    ASSERT_TRUE(judge.keeps_caps())
        << judge.finite << judge.in_range << judge.in_place << " power " << judge.most_power
        << " exact " << judge.most_exact << " pressure " << judge.most_pressure << " radiation "
        << judge.most_radiation << " mean " << judge.most_mean << " head " << judge.most_head;
    ASSERT_LE(judge.change, 0.025 * 1.001);
    ASSERT_LE(judge.step, 8.0 / 40e3 * 1.002);
    EXPECT_EQ(chain.safety().change + chain.safety().not_finite, 0) << "an emission has no faults";
    exceeded += raw.keeps_caps() ? 0 : 1;
  }
  EXPECT_EQ(exceeded, kCaps) << "every set of plans needs the limiter";
}

/// Plays samples from a function of time [samples] and focal point, in blocks of 40.
template <class Make>
Samples play(SampleChain& chain, Given& given, int samples, const Make& make, int first = 0) {
  const int foci = given.foci();
  Samples all, out(static_cast<std::size_t>(40 * foci));
  for (int at = 0; at < samples; at += 40) {
    given.next.clear();
    for (int i = 0; i < 40; ++i)
      for (int f = 0; f < foci; ++f) given.next.push_back(make(first + at + i, f));
    chain.fill(first + at, out);
    all.insert(all.end(), out.begin(), out.end());
  }
  return all;
}

/// Rises as fast as an emission may.
FocusSample at_full_output(int sample, int focus) {
  return {Eigen::Vector3f(0.02F * static_cast<float>(focus), 0.0F, 0.2F),
          std::min(1.0F, static_cast<float>(sample) / 40.0F)};
}

SampleLimits usx_limits(const SafetySettings& caps = {}) {
  static const auto kLevels = std::make_shared<const SafetyLevels>(usx_array(), Medium{}, 0.5);
  return {.caps = caps, .levels = kLevels};
}

TEST(SafetyLimiter, FullOutputOfTheShippedArraysPassesAtTheUsualHeight) {
  for (const TransducerArray& array : {usx_array(), autd3_array()}) {
    SampleLimits limits = usx_limits();
    limits.levels = std::make_shared<const SafetyLevels>(array, Medium{}, 0.5);
    Given given(4);
    SampleChain chain(given, limits);
    const Samples out = play(chain, given, 80'000, at_full_output);
    std::printf("%s: %.0f Pa, %.0f Pa of radiation, head %.1f dB\n", array.name.c_str(),
                chain.safety().acoustic_high, chain.safety().mean_high,
                limits.levels->head.estimate);
    for (std::size_t i = 4 * 40'000; i < out.size(); ++i) ASSERT_EQ(out[i].intensity, 1.0F);
    EXPECT_EQ(capped_samples(chain.safety()), 0) << array.name << main_cap(chain.safety());
    EXPECT_NEAR(chain.safety().head_estimate, limits.levels->head.estimate, 0.1);
  }
}

TEST(SafetyLimiter, FullOutputIsReached50MillisecondsAfterTheStartAndAfterSilence) {
  Given given(2);
  SampleChain chain(given, usx_limits());
  const auto full_after = [&](int first, const auto& make) {
    const Samples out = play(chain, given, 4000, make, first);
    for (std::size_t i = 2; i < out.size(); ++i)
      EXPECT_LE(std::abs(out[i].intensity - out[i - 2].intensity), 0.0251F);
    const auto full = std::ranges::find(out, 1.0F, &FocusSample::intensity);
    return (full - out.begin()) / 2;
  };
  EXPECT_NEAR(static_cast<double>(full_after(0, at_full_output)), 2000.0, 45.0);
  EXPECT_GT(chain.safety().ramp, 0);
  const auto silent = [](int, int f) { return FocusSample{at_full_output(0, f).p_D, 0.0F}; };
  play(chain, given, 3600, silent, 4000);
  EXPECT_LE(full_after(7600, at_full_output), 45) << "90 ms of silence need no ramp";
  play(chain, given, 4400, silent, 11'600);
  EXPECT_NEAR(static_cast<double>(full_after(16'000, at_full_output)), 2000.0, 45.0);
}

TEST(SafetyLimiter, AMeanCapActsGraduallyAndPersists) {
  SafetySettings caps;
  caps.mean_radiation_pressure = 100.0;
  Given given(4);
  SampleChain chain(given, usx_limits(caps));
  const Samples out = play(chain, given, 120'000, at_full_output);
  float rise = 0.0F, fall = 0.0F, most = 0.0F;
  for (std::size_t i = 4; i < out.size(); i += 4) {
    rise = std::max(rise, out[i].intensity - out[i - 4].intensity);
    fall = std::max(fall, out[i - 4].intensity - out[i].intensity);
    most = std::max(most, out[i].intensity);
  }
  EXPECT_LE(rise, 0.0251F);
  EXPECT_LE(fall, 0.0251F);
  EXPECT_GT(most, out.back().intensity * 1.2F) << "the start is stronger";
  const SafetyStats stats = chain.safety();
  EXPECT_GT(stats.mean_radiation_pressure, 0);
  EXPECT_EQ(erred_samples(stats), 0) << "a cap is not an error";
  EXPECT_NEAR(stats.mean_high, 100.0 / 1.1, 0.5) << "mean over 0.1 s that keeps the cap over 1 s";
  // steady at the end, at the level that the cap allows
  for (std::size_t i = 4 * 2500; i < out.size(); ++i)
    ASSERT_GT(out[i].intensity, 0.05F) << "no dip";
  for (std::size_t i = out.size() - 4 * 40'000; i < out.size(); ++i)
    ASSERT_NEAR(out[i].intensity, out.back().intensity, 1e-3F);
}

TEST(SafetyLimiter, ACapActsGraduallyWhenAFocalPointApproaches) {
  SafetySettings caps;
  caps.acoustic_pressure = 7e3;
  Given given(4);
  SampleChain chain(given, usx_limits(caps));
  // at 8 m/s, the largest speed of an emission
  const auto falling = [](int i, int f) {
    FocusSample s = at_full_output(i, f);
    s.p_D.z() = 0.35F - 0.2e-3F * static_cast<float>(std::clamp(i - 4000, 0, 1000));
    return s;
  };
  const Samples out = play(chain, given, 8000, falling);
  for (std::size_t i = 4; i < out.size(); ++i)
    ASSERT_LE(std::abs(out[i].intensity - out[i - 4].intensity), 0.0251F);
  for (std::size_t i = 4 * 5000; i < out.size(); ++i)
    ASSERT_EQ(out[i].p_D.z(), falling(static_cast<int>(i / 4), 0).p_D.z());
  EXPECT_EQ(chain.safety().jump, 0);
  EXPECT_GT(chain.safety().acoustic_pressure, 0);
  EXPECT_LE(chain.safety().acoustic_high, 7e3 * 1.001);
}

TEST(SafetyLimiter, ACapThatNeedsAFasterFallMutesAll) {
  SafetySettings caps;
  caps.acoustic_pressure = 7e3;
  Given given(2);
  SampleLimits limits = usx_limits(caps);
  limits.sample_rate = 400.0;  // so that 20 mm are not a jump
  SampleChain chain(given, limits);
  const auto nearing = [](int i, int f) {
    const float z = 0.4F - 0.019F * static_cast<float>(std::clamp(i - 100, 0, 15));
    return FocusSample{Eigen::Vector3f(f == 0 ? 0.0F : 0.02F, 0.0F, f == 0 ? z : 0.4F), 1.0F};
  };
  const Samples out = play(chain, given, 400, nearing);
  bool was_silent = false;
  for (std::size_t i = 2; i < out.size(); ++i) {
    ASSERT_LE(std::abs(out[i].intensity - out[i - 2].intensity), 0.0251F);
    was_silent = was_silent || (i > 200 && out[i].intensity == 0.0F);
  }
  EXPECT_TRUE(was_silent);
  EXPECT_EQ(chain.safety().jump, 0) << "due to the cap, not to a jump";
  EXPECT_GT(chain.safety().acoustic_pressure, 30);
  EXPECT_LE(chain.safety().acoustic_high, 7e3 * 1.001);
}

TEST(SafetyLimiter, AJumpIsHeldUntilThatFocalPointIsSilent) {
  Given given(2);
  SampleChain chain(given, usx_limits());
  const auto jumping = [](int i, int f) {
    FocusSample s = at_full_output(i, f);
    if (f == 0 && i >= 4000) s.p_D.x() = -0.02F;
    return s;
  };
  const Samples out = play(chain, given, 8000, jumping);
  for (std::size_t i = 2; i < out.size(); ++i) {
    ASSERT_LE(std::abs(out[i].intensity - out[i - 2].intensity), 0.0251F);
    if (i > 2 * 4000 && i % 2 == 1) {
      ASSERT_EQ(out[i].intensity, 1.0F) << "the other is unchanged";
    }
    if (out[i].p_D == out[i - 2].p_D) continue;
    ASSERT_EQ(out[i - 2].intensity, 0.0F);
    ASSERT_NEAR(static_cast<double>(i) / 2.0, 4040.0, 2.0);
  }
  EXPECT_EQ(out.back().intensity, 1.0F);
  EXPECT_NEAR(static_cast<double>(chain.safety().jump), 40.0, 1.0);
  EXPECT_EQ(capped_samples(chain.safety()) + erred_samples(chain.safety()), 0);
}

TEST(SafetyLimiter, AJumpMutesAllOnADeviceWithOneIntensity) {
  Given given(2);
  SampleLimits limits = usx_limits();
  limits.one_intensity = true;
  SampleChain chain(given, limits);
  const auto jumping = [](int i, int f) {
    FocusSample s = at_full_output(i, f);
    if (f == 0 && i >= 4000) s.p_D.x() = -0.02F;
    return s;
  };
  const Samples out = play(chain, given, 8000, jumping);
  for (std::size_t i = 0; i < out.size(); i += 2) ASSERT_EQ(out[i].intensity, out[i + 1].intensity);
  for (std::size_t i = 2; i < out.size(); i += 2) {
    if (out[i].p_D == out[i - 2].p_D) continue;
    ASSERT_EQ(out[i - 2].intensity, 0.0F);
    ASSERT_NEAR(static_cast<double>(i) / 2.0, 4040.0, 2.0);
  }
  EXPECT_EQ(out[out.size() - 2].p_D.x(), -0.02F);
}

TEST(SafetyLimiter, AJumpToAPositionWithMorePressureKeepsItsCap) {
  SafetySettings caps;
  caps.acoustic_pressure = 6e3;
  Given given(1);
  SampleChain chain(given, usx_limits(caps));
  const auto jumping = [](int i, int) {
    return FocusSample{Eigen::Vector3f(0.0F, 0.0F, i < 4000 ? 0.4F : 0.1F), 1.0F};
  };
  const Samples out = play(chain, given, 8000, jumping);
  for (std::size_t i = 1; i < out.size(); ++i) {
    ASSERT_LE(std::abs(out[i].intensity - out[i - 1].intensity), 0.0251F);
    if (out[i].p_D == out[i - 1].p_D) continue;
    ASSERT_LT(out[i].intensity, 0.03F) << "silent during the jump";
  }
  EXPECT_EQ(out.back().p_D.z(), 0.1F);
  EXPECT_GT(out.back().intensity, 0.2F);
  EXPECT_GT(chain.safety().jump, 30);
  EXPECT_LE(chain.safety().acoustic_high, 6e3 * 1.001);
}

TEST(SafetyLimiter, APositionTooCloseIsMuted) {
  Given given(1);
  SampleChain chain(given, usx_limits());
  const auto near = [](int i, int) {
    return FocusSample{Eigen::Vector3f(0.0F, 0.0F, i < 4000 ? 0.2F : 0.01F), 1.0F};
  };
  const Samples out = play(chain, given, 8000, near);
  EXPECT_EQ(out[3999].intensity, 1.0F);
  EXPECT_EQ(out[4045].intensity, 0.0F);
  EXPECT_EQ(out.back().intensity, 0.0F);
  EXPECT_GT(chain.safety().place, 0);
}

TEST(SafetyLimiter, AMuteActsWhateverTheSourceDoes) {
  Given given(2);
  SampleChain chain(given, usx_limits());
  const auto mute = std::make_shared<Mute>();
  chain.obey(mute);
  EXPECT_EQ(play(chain, given, 4000, at_full_output).back().intensity, 1.0F);
  mute->set(MuteReason::Person, true);
  const Samples out = play(chain, given, 8000, at_full_output, 4000);
  for (std::size_t i = 2; i < out.size(); ++i)
    ASSERT_LE(std::abs(out[i].intensity - out[i - 2].intensity), 0.0251F);
  for (std::size_t i = 2 * 401; i < out.size(); ++i) ASSERT_EQ(out[i].intensity, 0.0F);
  mute->set(MuteReason::Person, false);
  const Samples again = play(chain, given, 4000, at_full_output, 12'000);
  EXPECT_LT(again[2 * 1000].intensity, 0.6F) << "a ramp";
  EXPECT_EQ(again.back().intensity, 1.0F);
}

TEST(SafetySettings, ACapCanOnlyBeLowered) {
  const SafetySettings built_in;
  for (const SettingRow& row : setting_rows(group_of("safety", built_in).read))
    EXPECT_EQ(std::stod(row.value), row.setting.most) << row.setting.name;
  SafetySettings raised;
  raised.head_level = 146.0;
  EXPECT_THROW(SafetyLimiter({.caps = raised}), std::invalid_argument);
}

TEST(SafetyStats, DistinguishesErrorsFromCaps) {
  SafetyStats stats;
  stats.not_finite = 1;
  stats.head_level = 5;
  stats.jump = 2;
  EXPECT_EQ(erred_samples(stats), 1);
  EXPECT_EQ(capped_samples(stats), 5);
  EXPECT_STREQ(main_cap(stats), "head_level");
}

}  // namespace
}  // namespace prostm
