/// On devices that round positions, steps of focal points stay within 8 m/s, too.

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"
#include "prostm/device/device.hpp"
#include "prostm/emit/emitter.hpp"

namespace prostm {
namespace {

constexpr int kSteps = 4000;

/// A circle close to the others, so that a focal point that is slow enough moves over to it without
/// a jump.
LiftedPath circle(Random& random, double speed) {
  LiftedPath path;
  const Vec3 axis(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
  const Eigen::AngleAxisd turn(random.uniform(-0.2, 0.2), axis.normalized());
  const Vec3 centre(random.uniform(-2e-3, 2e-3), random.uniform(-2e-3, 2e-3), 0.2);
  constexpr int kPoints = 60;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 2.0 * kPi * i / kPoints;
    path.p_D.push_back(centre + turn * Vec3(0.02 * std::cos(angle), 0.02 * std::sin(angle), 0.0));
    path.pressure.push_back(1.0);
    path.s.push_back(path.length);
    path.length += 0.04 * std::sin(kPi / kPoints);
  }
  path.speed = speed;
  return path;
}

/// Returns the speed of the largest step that a device with rounded positions plays [m/s].
/// @param speed of the paths [m/s].  @param steps between plans.
double fastest(const DeviceInfo& info, double max_speed, double speed, int steps, Random& random) {
  EmitSettings settings;
  settings.foci = 1;
  settings.full_scale_pressure = 1.0;
  const auto emitter = make_emitter(Method::ProStm, settings, info.emission_rate(), max_speed);
  std::vector<FocusSample> samples(static_cast<std::size_t>(info.decimation));
  Vec3 last = Vec3::Zero();
  double most = 0.0;
  for (int step = 0; step < kSteps; ++step) {
    if (step % steps == 0) {
      emitter->draft().paths.assign(1, circle(random, speed));
      emitter->submit();
    }
    emitter->fill(static_cast<std::int64_t>(step) * info.decimation, samples);
    const Vec3 p = samples.front().p_D.cast<double>();
    const Vec3 played = (p / info.place_unit).array().round().matrix() * info.place_unit;
    if (step > 100) most = std::max(most, (played - last).norm() * info.sample_rate);
    last = played;
  }
  return most;
}

TEST(PlaceUnit, RoundedStepsStayWithinTheSpeedLimit) {
  Random random(3);
  for (const int decimation : {2, 4, 10}) {
    DeviceInfo info;
    info.sample_rate = 40e3 / decimation;
    info.decimation = decimation;
    info.place_unit = 0.025e-3;
    // one path at too high a speed, then many that the focal point moves over to
    for (const auto& [speed, steps] : {std::pair{12.0, kSteps}, std::pair{6.5, 100}}) {
      const double bounded = fastest(info, info.max_focus_speed(), speed, steps, random);
      EXPECT_LE(bounded, kMaxFocusSpeed) << decimation << ", " << speed;
      EXPECT_GT(bounded, info.max_focus_speed()) << decimation << ", " << speed;
      EXPECT_GT(fastest(info, kMaxFocusSpeed, speed, steps, random), kMaxFocusSpeed)
          << decimation << ", " << speed;
    }
  }
}

TEST(PlaceUnit, OtherDevicesUseTheFullSpeed) {
  EXPECT_EQ(DeviceInfo{}.max_focus_speed(), kMaxFocusSpeed);
}

}  // namespace
}  // namespace prostm
