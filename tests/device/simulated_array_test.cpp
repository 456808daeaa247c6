#include "prostm/device/simulated/simulated_array.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <thread>

#include "prostm/acoustics/array/transducer.hpp"
#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"
#include "prostm/emit/detail/envelope.hpp"
#include "prostm/emit/detail/focus_emitter.hpp"
#include "prostm/emit/detail/path_emitter.hpp"
#include "support/eventually.hpp"
#include "support/heap_guard.hpp"

namespace prostm {
namespace {

using test::eventually;
using Seconds = std::chrono::duration<double>;

/// Samples that carry their index.
class Counter final : public SampleSource {
 public:
  explicit Counter(int foci = 2) : foci_(foci) {}
  int foci() const override { return foci_; }
  void fill(std::int64_t first, std::span<FocusSample> out) noexcept override {
    consecutive = consecutive && first == next_;
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i].p_D.x() =
          static_cast<float>(first) + static_cast<float>(i / static_cast<std::size_t>(foci_));
      out[i].p_D.y() = static_cast<float>(i % static_cast<std::size_t>(foci_));
      out[i].intensity = 1.0F;
    }
    next_ = first + static_cast<std::int64_t>(out.size()) / foci_;
  }
  bool consecutive = true;

 private:
  int foci_;
  std::int64_t next_ = 0;
};

SimulatedArraySettings by_hand() {
  SimulatedArraySettings settings;
  settings.realtime = false;
  return settings;
}

template <class Settings>
SimulatedArray make(const Settings& settings) {
  return SimulatedArray(settings, usx_array(), Medium());
}

TEST(SimulatedArray, AdvancesByPullAndReadsBack) {
  SimulatedArray array = make(by_hand());
  EXPECT_EQ(array.status(), DeviceStatus::Idle);
  EXPECT_EQ(array.info().block_samples, 40);
  Counter counter(3);
  ASSERT_EQ(array.start(counter), DeviceStatus::Running);
  array.pull(100);
  EXPECT_EQ(array.samples(), 4000);
  EXPECT_EQ(array.foci(), 3);
  EXPECT_EQ(array.stats().blocks, 100);
  EXPECT_EQ(array.stats().late_blocks, 0);
  EXPECT_EQ(array.stats().queue_blocks, 3);
  const auto samples = array.read_back(1234, 100);
  ASSERT_EQ(samples.size(), 300u);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(samples[i].p_D.x(), static_cast<float>(1234 + i / 3));
    EXPECT_EQ(samples[i].p_D.y(), static_cast<float>(i % 3));
  }
  EXPECT_DOUBLE_EQ(array.play_time(4000), 0.1);
  EXPECT_THROW(array.read_back(3999, 2), std::out_of_range);
  EXPECT_THROW(array.read_back(-1, 1), std::out_of_range);
  EXPECT_THROW(array.read_back(0, std::numeric_limits<std::int64_t>::max()), std::out_of_range);
  EXPECT_TRUE(array.read_back(4000, 0).empty());
}

TEST(SimulatedArray, KeepsTheRequestedHistory) {
  SimulatedArraySettings settings = by_hand();
  settings.history = 0.5;
  SimulatedArray array = make(settings);
  Counter counter;
  array.start(counter);
  array.pull(2000);
  EXPECT_EQ(array.samples(), 80000);
  const auto samples = array.read_back(60000, 20000);
  for (std::size_t i = 0; i < 20000; ++i) {
    ASSERT_EQ(samples[2 * i].p_D.x(), static_cast<float>(60000 + i));
  }
  EXPECT_THROW(array.read_back(59999, 1), std::out_of_range);
  EXPECT_TRUE(counter.consecutive);
}

TEST(SimulatedArray, PullDoesNotAllocate) {
  SimulatedArray array = make(by_hand());
  Counter counter;
  array.start(counter);
  const test::HeapGuard guard;
  array.pull(100);
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(SimulatedArray, SegmentsRepeatAndSwitchAtTheirEnd) {
  SimulatedArray array = make(by_hand());
  const auto segment = [](std::size_t samples, float mark) {
    std::vector<FocusSample> out(samples * 2);
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i].p_D = Eigen::Vector3f(static_cast<float>(i / 2), mark, 0.2F);
      out[i].intensity = 0.5F;
    }
    return out;
  };
  ASSERT_EQ(array.load_segment(segment(70, 1.0F), 2), DeviceStatus::Running);
  array.pull(5);  // 200 samples: two laps and 60 samples
  ASSERT_EQ(array.load_segment(segment(30, 2.0F), 2), DeviceStatus::Running);
  array.pull(5);
  const auto samples = array.read_back(0, 400);
  for (std::size_t i = 0; i < 400; ++i) {
    const bool old = i < 210;
    EXPECT_EQ(samples[2 * i].p_D.y(), old ? 1.0F : 2.0F) << i;
    EXPECT_EQ(samples[2 * i].p_D.x(), static_cast<float>(old ? i % 70 : (i - 210) % 30)) << i;
  }
}

TEST(SimulatedArray, RejectsInvalidCallsWithASentence) {
  SimulatedArray array = make(by_hand());
  Counter nine(9), two(2), other(2);
  EXPECT_EQ(array.start(nine), DeviceStatus::Refused);
  EXPECT_EQ(array.status(), DeviceStatus::Refused);
  EXPECT_EQ(array.problem(),
            "The stream has 9 focal points a sample; the simulated array plays 1 to 8.");
  EXPECT_EQ(array.load_segment(std::vector<FocusSample>(5), 2), DeviceStatus::Refused);
  EXPECT_EQ(array.load_segment({}, 2), DeviceStatus::Refused);
  EXPECT_EQ(array.load_segment(std::vector<FocusSample>(4), 0), DeviceStatus::Refused);
  std::vector<FocusSample> bad(4);
  bad[3].p_D.z() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(array.load_segment(bad, 2), DeviceStatus::Refused);
  EXPECT_EQ(
      array.problem(),
      "Sample 1 of the segment has a number that is not finite or an intensity outside of 0 to 1.");

  // a refused start does not stop the running loop or stream
  ASSERT_EQ(array.start(two), DeviceStatus::Running);
  EXPECT_EQ(array.problem(), "");
  EXPECT_EQ(array.start(other), DeviceStatus::Refused);
  EXPECT_EQ(array.load_segment(std::vector<FocusSample>(4), 2), DeviceStatus::Refused);
  EXPECT_EQ(array.status(), DeviceStatus::Running);
  array.stop();
  EXPECT_EQ(array.status(), DeviceStatus::Idle);

  SimulatedFaults faults;
  faults.refuse = true;
  array.set_faults(faults);
  EXPECT_EQ(array.start(two), DeviceStatus::Refused);
  EXPECT_EQ(array.load_segment(std::vector<FocusSample>(4), 2), DeviceStatus::Refused);
  EXPECT_NE(array.problem(), "");
  array.set_faults({});
  EXPECT_EQ(array.start(two), DeviceStatus::Running);
}

TEST(SimulatedArray, VanishesAndReturns) {
  for (const bool realtime : {false, true}) {
    SimulatedArraySettings settings;
    settings.realtime = realtime;
    SimulatedArray array = make(settings);
    SimulatedFaults faults;
    faults.vanish_after = 20;
    array.set_faults(faults);
    Counter counter;
    ASSERT_EQ(array.start(counter), DeviceStatus::Running);
    if (!realtime) array.pull(50);
    ASSERT_TRUE(eventually([&] { return array.status() == DeviceStatus::Vanished; }));
    EXPECT_EQ(array.status(), DeviceStatus::Vanished);
    EXPECT_EQ(array.problem(),
              "The simulated array vanished after 20 blocks, as requested; start it again.");
    EXPECT_EQ(array.stats().blocks, 20);
    array.set_faults({});
    Counter again;
    EXPECT_EQ(array.start(again), DeviceStatus::Running);
    if (!realtime) array.pull(50);
    ASSERT_TRUE(eventually([&] { return array.stats().blocks >= 30; }));
    EXPECT_GE(array.stats().blocks, 30);
    EXPECT_EQ(array.status(), DeviceStatus::Running);
    array.stop();
  }
}

TEST(SimulatedArray, KeepsRealTime) {
  SimulatedArray array = make(SimulatedArraySettings());
  Counter counter;
  const auto start = std::chrono::steady_clock::now();
  ASSERT_EQ(array.start(counter), DeviceStatus::Running);
  EXPECT_EQ(array.stats().queue_blocks, 10) << "it starts with the longest queue";
  ASSERT_TRUE(eventually([&] { return array.stats().blocks >= 200; }));
  const auto now = [] {
    return Seconds(std::chrono::steady_clock::now().time_since_epoch()).count();
  };
  const double elapsed = Seconds(std::chrono::steady_clock::now() - start).count();
  EXPECT_GE(elapsed, 0.199);  // never early: block 199 is requested at 199 ms
  // played samples lie in the past, and later ones in the future; a late block may shift both
  // between two calls
  EXPECT_TRUE(eventually([&] {
    const double played = array.play_time(array.samples() - 1);
    return played <= now();
  }));
  EXPECT_TRUE(eventually([&] {
    const double before = now();
    return array.play_time(array.samples() + 400) > before;
  }));
  array.stop();
  const std::int64_t played = array.stats().blocks * 40;
  EXPECT_LE(array.samples(), played);
  ASSERT_TRUE(eventually([&] { return array.samples() == played; }));  // the queue is played out
  const auto samples = array.read_back(played - 40, 40);
  for (std::size_t i = 0; i < 40; ++i) {
    EXPECT_EQ(samples[2 * i].p_D.x(), static_cast<float>(played - 40) + static_cast<float>(i));
  }
  EXPECT_TRUE(counter.consecutive);
  EXPECT_EQ(array.status(), DeviceStatus::Idle);
}

TEST(SimulatedArray, DelayMakesBlocksLateAndThenMissed) {
  SimulatedArraySettings settings;
  settings.queue_blocks = 10;  // the largest queue
  SimulatedArray array = make(settings);
  SimulatedFaults faults;
  faults.delay = 3e-3;
  array.set_faults(faults);
  Counter counter;
  array.start(counter);
  ASSERT_TRUE(eventually([&] { return array.stats().blocks >= 50; }));
  array.stop();
  EXPECT_EQ(array.stats().late_blocks, array.stats().blocks);

  faults.delay = 30e-3;  // longer than any queue
  array.set_faults(faults);
  Counter again;
  array.start(again);
  ASSERT_TRUE(eventually([&] { return array.stats().blocks >= 3; }));
  array.stop();
  EXPECT_GE(array.stats().missed_blocks, 20);
  EXPECT_TRUE(again.consecutive);  // no sample is skipped
}

TEST(SimulatedArray, StreamsPlansThatArriveInTheMeantime) {
  SimulatedArray array = make(SimulatedArraySettings());
  EmitSettings settings;
  settings.full_scale_pressure = 1.0;
  PathEmitter emitter(settings, array.info().sample_rate);
  ASSERT_EQ(array.start(emitter), DeviceStatus::Running);
  Random random(1);
  TakeOver report;
  for (int k = 0; k < 100; ++k) {
    LiftedPlan& plan = emitter.draft();
    plan.id = k;
    plan.paths.clear();
    for (int p = 0; p < 4; ++p) {
      LiftedPath path;
      path.speed = 7.0;
      const Vec3 centre(0.05 * p, 0.001 * k, 0.2);
      for (int i = 0; i < 30; ++i) {
        const double a = 2.0 * kPi * i / 30.0;
        path.p_D.push_back(centre + 0.015 * Vec3(std::cos(a), std::sin(a), 0.0));
        path.pressure.push_back(random.uniform());
      }
      plan.paths.push_back(path);
    }
    emitter.submit();
    while (emitter.next_take_over(report)) array.play_time(report.first_sample);
    array.stats();
    emitter.stats();
    std::this_thread::sleep_for(std::chrono::milliseconds(4));
  }
  array.stop();
  const EmitStats stats = emitter.stats();
  EXPECT_EQ(stats.samples, array.stats().blocks * 160);
  EXPECT_LE(stats.max_focus_step, 0.2e-3);
  EXPECT_GT(stats.laps_started, 40);
}

/// Plays the same focal points for 20 ms. @return the final rms acoustic pressure at each.
std::vector<double> reached(const SimulatedArraySettings& settings,
                            const std::vector<FocusSample>& foci) {
  SimulatedArray array = make(settings);
  const auto count = static_cast<int>(foci.size());
  EXPECT_EQ(array.load_segment(foci, count), DeviceStatus::Running);
  array.pull(20);
  std::vector<Vec3> points;
  for (const FocusSample& focus : foci) points.push_back(focus.p_D.cast<double>());
  return array.pressure(799, 1, points);
}

TEST(SimulatedArray, HalfTheTargetGivesHalfTheRadiationPressureOfAModulatedFocus) {
  EmitSettings settings;
  settings.foci = 1;
  settings.full_scale_pressure = 10.0;
  SimulatedArraySettings simulated = by_hand();
  simulated.memoryless = true;
  // the mean and the maximum over a period
  const auto reached = [&](double pressure) {
    SimulatedArray array = make(simulated);
    FocusEmitter emitter(settings, array.info().sample_rate);
    const Vec3 p_D(0.01, -0.02, 0.18);
    emitter.draft().foci.push_back({p_D, pressure});
    emitter.submit();
    EXPECT_EQ(array.start(emitter), DeviceStatus::Running);
    array.pull(20);
    double sum = 0.0, largest = 0.0;
    for (const double p : array.pressure(400, emitter.period(), std::vector<Vec3>{p_D})) {
      sum += radiation_pressure(p, Medium{});
      largest = std::max(largest, radiation_pressure(p, Medium{}));
    }
    array.stop();
    return std::pair(sum / static_cast<double>(emitter.period()), largest);
  };
  const auto full = reached(10.0), half = reached(5.0);
  EXPECT_NEAR(half.first / full.first, 0.5, 1e-4);
  EXPECT_NEAR(half.second / full.second, 0.5, 1e-4);
  EXPECT_NEAR(full.first / full.second, 0.5, 1e-4);  // sine-magnitude modulation
}

TEST(SimulatedArray, AtZerosOfTheModulationTransducersRingAsTheirMemoryPredicts) {
  const TransducerSettings transducer;
  const double tau_turns = time_constant(transducer) * 200.0;
  for (const Waveform waveform : {Waveform::SineMagnitude, Waveform::RaisedCosine}) {
    TransducerDynamics dynamics(transducer, 1);
    for (int k = 0; k <= 400; ++k) {
      const std::complex<double> drive = envelope(waveform, k % 200 / 200.0);
      dynamics.step(std::span(&drive, 1));
    }
    const double rings = std::abs(dynamics.output()[0]), x = kPi * tau_turns;  // (B6)
    EXPECT_NEAR(rings, waveform == Waveform::SineMagnitude ? x : 2.0 * x * x, 0.15 * rings)
        << name_of(waveform);
  }
}

TEST(SimulatedArray, HalfTheTargetGivesHalfTheRadiationPressure) {
  for (const FocusMethod solver :
       {FocusMethod::Weighted, FocusMethod::GsPat, FocusMethod::Superposition}) {
    const auto pressure_at = [&](double target) {
      bool saturated = false;
      FocusSample sample;
      sample.p_D = Eigen::Vector3f(0.01F, -0.02F, 0.18F);
      sample.intensity = static_cast<float>(drive_intensity(target, 10.0, 0.01, saturated));
      SimulatedArraySettings settings = by_hand();
      settings.solver = solver;
      return radiation_pressure(reached(settings, {sample})[0], Medium());
    };
    EXPECT_NEAR(pressure_at(2.5) / pressure_at(5.0), 0.5, 1e-4);
    EXPECT_NEAR(pressure_at(0.2) / pressure_at(5.0), 0.04, 1e-4);
  }
}

TEST(SimulatedArray, OneFocusAtFullDriveUsesTheWholeArray) {
  const Vec3 focus(0.0, 0.0, 0.2);
  const TransducerArray usx = usx_array();
  double sum = 0.0;
  for (std::size_t i = 0; i < 256; ++i) sum += std::abs(propagate(usx, Medium(), i, focus));
  const FocusSample sample{focus.cast<float>(), 1.0F};
  EXPECT_NEAR(reached(by_hand(), {sample})[0], sum, 1e-4 * sum);
}

TEST(SimulatedArray, AnIntensityGivesTheSamePressureEverywhereWithinTheBound) {
  const auto pressure_at = [&](const Vec3& p) {
    return reached(by_hand(), {{p.cast<float>(), 0.4F}})[0];
  };
  const double here = pressure_at({0.0, 0.0, 0.2});
  EXPECT_NEAR(pressure_at({0.05, -0.04, 0.25}), here, 1e-3 * here);
  EXPECT_NEAR(pressure_at({0.0, 0.02, 0.12}), here, 1e-3 * here);
  EXPECT_LT(pressure_at({0.0, 0.0, 0.8}), 0.9 * here);  // the array reaches a quarter of it there
}

TEST(SimulatedArray, SeveralFociKeepTheirRatios) {
  std::vector<FocusSample> foci(4);
  for (std::size_t f = 0; f < 4; ++f) {
    foci[f].p_D = Eigen::Vector3f(0.03F * static_cast<float>(f) - 0.045F, 0.0F, 0.2F);
    foci[f].intensity = f == 0 ? 0.5F : 1.0F;
  }
  const std::vector<double> together = reached(by_hand(), foci);
  double power = 0.0;
  for (std::size_t f = 0; f < 4; ++f) {
    double alone = 0.0;
    for (std::size_t i = 0; i < 256; ++i) {
      alone += std::abs(propagate(usx_array(), Medium(), i, foci[f].p_D.cast<double>()));
    }
    power += std::pow(together[f] / alone, 2);
  }
  for (std::size_t f = 1; f < 4; ++f) EXPECT_NEAR(together[f] / together[0], 2.0, 0.01);
  EXPECT_GT(power, 0.75);  // bound by (A4)
}

TEST(SimulatedArray, TransducersLagUnlessMemoryless) {
  // silence, then a focal point: after one time constant it has reached 1 − 1/e
  std::vector<FocusSample> step(800, {Eigen::Vector3f(0.0F, 0.0F, 0.2F), 0.0F});
  for (std::size_t i = 400; i < 800; ++i) step[i].intensity = 1.0F;
  for (const bool memoryless : {false, true}) {
    SimulatedArraySettings settings = by_hand();
    settings.memoryless = memoryless;
    SimulatedArray array = make(settings);
    ASSERT_EQ(array.load_segment(step, 1), DeviceStatus::Running);
    array.pull(20);
    const std::vector<Vec3> points{Vec3(0.0, 0.0, 0.2)};
    const auto samples = static_cast<std::int64_t>(std::lround(time_constant({}) * 40e3));
    const double early = array.pressure(400 + samples - 1, 1, points)[0];
    const double late = array.pressure(799, 1, points)[0];
    EXPECT_NEAR(early / late, memoryless ? 1.0 : 1.0 - std::exp(-1.0), 0.01);
  }
}

TEST(SimulatedArray, AnyRangeOfTheOutputIsTheSame) {
  SimulatedArray array = make(by_hand());
  std::vector<FocusSample> circle;
  for (int i = 0; i < 800; ++i) {
    const double angle = 2.0 * kPi * i / 800.0;
    circle.push_back(
        {Vec3(0.022 * std::cos(angle), 0.022 * std::sin(angle), 0.2).cast<float>(), 1.0F});
  }
  ASSERT_EQ(array.load_segment(circle, 1), DeviceStatus::Running);
  array.pull(40);
  const auto whole = array.output(0, 1600), part = array.output(1200, 100);
  ASSERT_EQ(part.size(), 100U * 256U);
  for (std::size_t i = 0; i < part.size(); ++i) {
    ASSERT_LT(std::abs(part[i] - whole[1200 * 256 + i]), 1e-3);
  }
  EXPECT_THROW(array.output(1500, 101), std::out_of_range);
  EXPECT_THROW(array.output(-1, 1), std::out_of_range);
}

TEST(SimulatedArray, SettingsAreChecked) {
  SimulatedArraySettings settings = by_hand();
  settings.queue_blocks = 11;
  try {
    make(settings);
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_STREQ(e.what(), "queue_blocks = 11 must be between 1 and 10");
  }
  settings = by_hand();
  settings.queue_blocks = 9;
  settings.most_queue_blocks = 3;
  try {
    make(settings);
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_STREQ(e.what(), "most_queue_blocks = 3 must be between 9 and 10");
  }
  settings = by_hand();
  settings.sample_rate = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(make(settings), std::invalid_argument);
  settings = by_hand();
  settings.solver = FocusMethod::LevenbergMarquardt;
  EXPECT_THROW(make(settings), std::invalid_argument);
  settings = by_hand();
  settings.max_foci = 0;
  EXPECT_THROW(make(settings), std::invalid_argument);
}

}  // namespace
}  // namespace prostm
