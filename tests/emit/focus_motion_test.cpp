#include "prostm/emit/detail/focus_motion.hpp"

#include <gtest/gtest.h>

#include "emit/paths.hpp"

namespace prostm {
namespace {

constexpr double kStep = 0.1998e-3;  // slightly less than 8 m/s at 40 kHz [m]

/// Counts samples until the focal point is on `to`, after half a lap on `from`. Checks every step.
int samples_to_join(const LiftedPath& from, const LiftedPath& to) {
  FocusMotion motion;
  motion.configure(40e3, kStep);
  motion.jump(from, nearest_place(from, from.p_D[0]));
  for (int i = 0; i < 400; ++i) motion.advance();
  motion.join(to, nearest_place(to, motion.position()));
  for (int i = 0; i < 5000; ++i) {
    const Vec3 before = motion.position();
    motion.advance();
    EXPECT_LE((motion.position() - before).norm(), kStep * (1.0 + 1e-9));
    if (motion.on_path()) return i + 1;
  }
  return -1;
}

TEST(FocusMotion, AnOffsetPerpendicularToThePathClosesFastest) {
  const LiftedPath a = test::ring(Vec3(0, 0, 0.20), 0.140, 100, 1.0);
  const LiftedPath b = test::ring(Vec3(0, 0, 0.205), 0.140, 100, 1.0);
  // √(Δ² − 0.175²) = 0.0964 mm per sample
  EXPECT_NEAR(samples_to_join(a, b), 5.0 / 0.0964, 2.0);
}

TEST(FocusMotion, AnyOffsetClosesWithTheSpareStep) {
  Random random(2);
  for (int round = 0; round < 200; ++round) {
    const Vec3 shift(random.normal(), random.normal(), random.normal());
    const LiftedPath a = test::ring(Vec3(0, 0, 0.2), 0.140, 100, 1.0);
    const LiftedPath b =
        test::ring(Vec3(0, 0, 0.2) + 4e-3 * shift, random.uniform(0.05, 0.14), 60, 1.0);
    const double distance = nearest_place(b, point_at(a, 0.07).p_D).distance;
    const int samples = samples_to_join(a, b);
    EXPECT_GT(samples, 0);
    EXPECT_LE(samples, distance / (kStep - 0.175e-3) + 2.0);
  }
}

TEST(FocusMotion, ReachDependsOnSpeedAndDistance) {
  FocusMotion motion;
  motion.configure(40e3, kStep);
  LiftedPath path = test::ring(Vec3(0, 0, 0.2), 0.140, 100, 1.0);
  PathPlace place;
  place.distance = 9.9e-3;
  EXPECT_TRUE(motion.reaches(path, place));
  place.distance = 10.1e-3;
  EXPECT_FALSE(motion.reaches(path, place));
  path.speed = 8.0;  // no spare step
  place.distance = 1e-3;
  EXPECT_FALSE(motion.reaches(path, place));
}

TEST(FocusMotion, LapsAreIntegerNumbersOfSamples) {
  FocusMotion motion;
  motion.configure(40e3, kStep);
  Random random(3);
  for (int round = 0; round < 100; ++round) {
    const double length = random.uniform(0.001, 0.2), speed = random.uniform(0.5, 12.0);
    const LiftedPath path = test::ring(Vec3(0, 0, 0.2), length, 100, 1.0, speed);
    motion.jump(path, nearest_place(path, path.p_D[17]));
    const double step = std::min(speed / 40e3, kStep);
    EXPECT_NEAR(static_cast<double>(motion.lap_samples()), length / step + 0.5, 0.51);
    for (std::int64_t k = 0; k < motion.lap_samples(); ++k) motion.advance();
    EXPECT_TRUE(motion.lap_ended());
    EXPECT_LT((motion.position() - path.p_D[17]).norm(), 1e-12);
  }
}

TEST(FocusMotion, ALapBackwardsPassesTheFirstPointLikeAnyOther) {
  // starts a whole fraction of a lap away, so that the remaining arc is zero up to rounding
  Random random(4);
  for (int round = 0; round < 300; ++round) {
    const LiftedPath path =
        test::ring(Vec3(0, 0, 0.2), random.uniform(0.05, 0.14), 4 * (1 + round % 20), 1.0);
    FocusMotion motion;
    motion.configure(40e3, kStep);
    motion.jump(path, nearest_place(path, path.p_D[0]));
    motion.advance();
    PathPlace place = nearest_place(path, path.p_D[path.p_D.size() / 4]);
    place.tangent = point_at(path, 0.0).p_D - motion.position();  // opposite to its direction
    motion.join(path, place);
    for (std::int64_t k = 0; k < 2 * motion.lap_samples(); ++k) {
      const Vec3 before = motion.position();
      motion.advance();
      ASSERT_LE((motion.position() - before).norm(), kStep * (1.0 + 1e-9)) << round;
    }
  }
}

}  // namespace
}  // namespace prostm
