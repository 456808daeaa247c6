// Whole emissions through the adapter, against the stand-in of the SDK's interface.
#include <gmock/gmock.h>

#include <cmath>
#include <thread>

#include "emit/paths.hpp"
#include "prostm/device/safety/sample_chain.hpp"
#include "prostm/emit/emitter.hpp"
#include "support/eventually.hpp"
#include "ultraleap/listening.hpp"

namespace prostm {
namespace {

namespace ulh = test::ulh;
using test::Listener;
using test::Numbered;
using test::setup_of;
namespace stand_in = test::stand_in;

constexpr double kAudible = 0.01;

/// Largest steps in the stand-in's emission.
class StepWatch {
 public:
  StepWatch() {
    stand_in::set_sink(
        [this](ulh::LocalTimePoint, std::span<const ulh::ControlPoint> points) { look(points); });
  }
  ~StepWatch() { stand_in::set_sink(nullptr); }
  StepWatch(const StepWatch&) = delete;
  StepWatch& operator=(const StepWatch&) = delete;

  double step = 0.0;    ///< of a point above 1 % in both samples [m]
  double change = 0.0;  ///< of an intensity
  double sum = 0.0;     ///< of intensities
  std::int64_t samples = 0;

 private:
  void look(std::span<const ulh::ControlPoint> points) {
    for (std::size_t f = 0; f < points.size(); ++f) {
      const ulh::Vector3 at = points[f].getPosition();
      const FocusSample now{Eigen::Vector3f(at.x, at.y, at.z), points[f].getIntensity()};
      const FocusSample before = samples > 0 ? last_[f] : FocusSample();
      const auto a = static_cast<double>(before.intensity), b = static_cast<double>(now.intensity);
      change = std::max(change, std::abs(a - b));
      if (a > kAudible && b > kAudible)
        step = std::max(step, static_cast<double>((now.p_D - before.p_D).norm()));
      sum += b;
      last_[f] = now;
    }
    ++samples;
  }
  FocusSample last_[8];
};

/// Three paths that drift, cross and change their strength.
void submit_paths(Emitter& emitter, int number) {
  LiftedPlan& plan = emitter.draft();
  plan = {};
  plan.id = number + 1;
  for (int k = 0; k < 3; ++k) {
    const double t = 0.04 * number;
    const Vec3 centre(0.02 * std::sin(t + 2.1 * k), 0.02 * std::cos(0.7 * t + k), 0.2);
    const double pressure = 0.5 + 0.4 * std::sin(1.3 * t + k);
    plan.paths.push_back(test::ring(centre, 0.10 + 0.03 * std::sin(t), 40, pressure));
  }
  emitter.submit();
}

void submit_foci(Emitter& emitter, int number) {
  LiftedPlan& plan = emitter.draft();
  plan = {};
  plan.id = number + 1;
  for (int k = 0; k < 3; ++k) {
    const double t = 0.04 * number;
    plan.foci.push_back({Vec3(0.02 * std::sin(t + 2.1 * k), 0.02 * std::cos(0.7 * t + k), 0.2),
                         0.5 + 0.4 * std::sin(1.3 * t + k)});
  }
  emitter.submit();
}

/// A minute at 16 kHz with 25 plans a second, stepped by hand.
void play_a_minute(Method method, float least_separation) {
  stand_in::Array array;
  array.separation = least_separation;
  stand_in::reset({array});
  stand_in::set_manual(true);
  StepWatch watch;
  const auto device = make_ultraleap(setup_of(3));
  const DeviceInfo& info = device->info();
  ASSERT_EQ(info.sample_rate, 16e3);
  ASSERT_EQ(info.emission_rate(), 48e3);
  EmitSettings settings;
  settings.foci = 3;
  settings.full_scale_pressure = 1.0;
  const auto emitter = make_emitter(method, settings, info.emission_rate());
  const auto chain = make_sample_chain(*emitter, info, {.power = settings.power_limit});
  ASSERT_EQ(device->start(*chain), DeviceStatus::Running);
  for (int plan = 0; plan < 1'500; ++plan) {
    method == Method::ProStm ? submit_paths(*emitter, plan) : submit_foci(*emitter, plan);
    stand_in::step(40);
  }
  EXPECT_EQ(device->status(), DeviceStatus::Running) << device->problem();
  const DeviceStats stats = device->stats();
  EXPECT_EQ(stats.blocks, 60'000);
  EXPECT_EQ(stats.late_blocks, 0);
  EXPECT_EQ(stats.missed_blocks, 0);
  EXPECT_EQ(watch.samples, 960'000);
  EXPECT_EQ(chain->limited(), 0);
  EXPECT_EQ(stand_in::violations(), 0) << stand_in::last_violation();
  EXPECT_LE(watch.step, 8.0 / 16e3 * (1.0 + 1e-3)) << "8 m/s";
  // the emission's own bound, plus a step of the separation's fade
  EXPECT_LE(watch.change, 3.0 / 40.0 + 1.0 / 16.0 + 1e-3);
  EXPECT_GT(watch.sum / 960'000, 0.3) << "the output is on";
}

TEST(UltraleapEmission, PlaysPathsForAMinute) {
  play_a_minute(Method::ProStm, 0.0F);
}

TEST(UltraleapEmission, PlaysPathsThatComeTooCloseForAMinute) {
  play_a_minute(Method::ProStm, 0.02F);
}

TEST(UltraleapEmission, PlaysFociForAMinute) {
  play_a_minute(Method::Am, 0.02F);
}

TEST(UltraleapEmission, KeepsTimeAndFadesOutAtTheEnd) {
  stand_in::reset({stand_in::Array{}});
  const auto device = make_ultraleap(setup_of(3));
  Listener listener(64'000);
  Numbered source(3);
  const double before =
      std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  ASSERT_EQ(device->start(source), DeviceStatus::Running);
  ASSERT_TRUE(test::eventually([&] { return device->samples() > 8'000; }));
  const std::int64_t sample = device->samples() - 1;
  const double now =
      std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  EXPECT_LE(device->play_time(sample), now + 1e-3);
  EXPECT_LT(device->ask_time(sample), device->play_time(sample));
  EXPECT_GT(device->play_time(sample), before + 0.4);
  EXPECT_GE(device->stats().blocks, 400);
  EXPECT_GT(device->stats().queue_blocks, 0);
  device->stop();
  EXPECT_EQ(device->status(), DeviceStatus::Idle);
  EXPECT_TRUE(source.in_order());
  EXPECT_EQ(stand_in::violations(), 0) << stand_in::last_violation();
  const auto heard = listener.heard();
  ASSERT_GT(heard.size(), 8'000U);
  float largest = 0.0F;
  for (std::size_t i = 1; i < heard.size(); ++i) {
    largest =
        std::max(largest, std::abs(heard[i].point[1].intensity - heard[i - 1].point[1].intensity));
  }
  EXPECT_LE(largest, 1.0F / 16.0F + 1e-3F);
  EXPECT_EQ(heard.back().point[1].intensity, 0.0F);
}

TEST(UltraleapEmission, StartsAndStopsManyTimes) {
  stand_in::reset({stand_in::Array{}});
  const auto device = make_ultraleap(setup_of(2));
  for (int i = 0; i < 10; ++i) {
    auto source = std::make_unique<Numbered>(2);
    ASSERT_EQ(device->start(*source), DeviceStatus::Running);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    if (i % 3 == 2) {
      stand_in::disconnect("MockDevice:USX");
      stand_in::reconnect("MockDevice:USX");
      EXPECT_EQ(device->status(), DeviceStatus::Vanished);
    }
    if (i % 2 == 0) device->stop();
    // otherwise the next start() releases it
    if (i % 2 == 1) {
      Numbered other(2);
      ASSERT_EQ(device->start(other), DeviceStatus::Running);
      device->stop();
    }
    EXPECT_TRUE(source->in_order());
  }
  EXPECT_EQ(stand_in::violations(), 0) << stand_in::last_violation();
}

}  // namespace
}  // namespace prostm
