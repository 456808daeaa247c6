#include "prostm/emit/detail/start_place.hpp"

#include <gtest/gtest.h>

#include <array>

#include "emit/paths.hpp"

namespace prostm {
namespace {

constexpr double kStep = 0.1998e-3;  // slightly less than 8 m/s at 40 kHz [m]
const Vec3 kCentre(0.0, 0.0, 0.2);

FocusMotion started(const LiftedPath& path, std::int64_t samples) {
  FocusMotion motion;
  motion.configure(40e3, kStep);
  motion.jump(path, first_place(path));
  for (std::int64_t i = 0; i < samples; ++i) motion.advance();
  return motion;
}

TEST(FocusMotion, PredictsItsPosition) {
  Random random(1);
  for (int round = 0; round < 100; ++round) {
    const LiftedPath path = test::ring(kCentre, random.uniform(0.0001, 0.14), 30, 1.0,
                                       round % 10 == 0 ? 0.0 : random.uniform(0.1, 9.0));
    FocusMotion motion = started(path, random.below(3000));
    const int ahead = random.below(3000);
    const Vec3 said = motion.ahead(ahead);
    EXPECT_LT((motion.ahead(0) - motion.position()).norm(), 1e-12);
    for (int i = 0; i < ahead; ++i) motion.advance();
    EXPECT_LT((motion.position() - said).norm(), 1e-12) << round;
  }
}

TEST(StartPlace, FirstIsThePathsFirstPoint) {
  const LiftedPath path = test::ring(kCentre, 0.1, 40, 1.0);
  EXPECT_EQ(first_place(path).s, 0.0);
  EXPECT_EQ(first_place(path).p_D, path.p_D[0]);
}

TEST(StartPlace, ApartIsTheBestOfAllCandidates) {
  // plays two laps from each of 32 positions
  Random random(2);
  for (int round = 0; round < 20; ++round) {
    std::array<FocusMotion, 3> others;
    std::array<const FocusMotion*, 3> pointers;
    for (std::size_t i = 0; i < others.size(); ++i) {
      const Vec3 centre = kCentre + Vec3(random.uniform(-0.05, 0.05), random.uniform(0.04, 0.1),
                                         random.uniform(-0.01, 0.01));
      others[i] =
          started(test::ring(centre, random.uniform(0.06, 0.14), 40, 1.0), random.below(700));
      pointers[i] = &others[i];
    }
    const LiftedPath path = test::ring(kCentre, random.uniform(0.1, 0.14), 40, 1.0);
    FocusMotion silent;
    silent.configure(40e3, kStep);
    const PathPlace chosen = place_apart(path, silent, pointers);
    const auto cost = [&](const PathPlace& place) {
      FocusMotion motion = silent;
      motion.jump(path, place);
      double sum = 0.0;
      for (std::int64_t i = 0; i < 2 * motion.lap_samples(); ++i) {
        for (const FocusMotion& other : others) {
          sum += std::pow(1e3 * (other.ahead(i) - motion.ahead(i)).norm(), -8.0);
        }
      }
      return sum;
    };
    EXPECT_LT((point_at(path, chosen.s).p_D - chosen.p_D).norm(), 1e-12);
    for (int place = 0; place < 32; ++place) {
      PathPlace other;
      other.s = path.length * place / 32.0;
      other.p_D = point_at(path, other.s).p_D;
      // the 64 instants checked do not cover all samples
      EXPECT_GT(cost(other), 0.7 * cost(chosen)) << round;
    }
  }
}

TEST(StartPlace, PointsAndVerySlowPathsAreHandled) {
  FocusMotion silent;
  silent.configure(40e3, kStep);
  const LiftedPath ring = test::ring(kCentre, 0.14, 40, 1.0),
                   slow = test::ring(kCentre, 0.14, 40, 1.0, 1e-3),
                   still = test::ring(kCentre, 0.14, 40, 1.0, 0.0),
                   point = test::point(ring.p_D[10], 1.0);
  const FocusMotion on_ring = started(ring, 100), on_slow = started(slow, 100),
                    on_point = started(point, 100);
  for (const LiftedPath* path : {&ring, &slow, &still, &point}) {
    for (const FocusMotion* other : {&on_ring, &on_slow, &on_point}) {
      const std::array<const FocusMotion*, 1> others{other};
      const PathPlace place = place_apart(*path, silent, others);
      EXPECT_TRUE(place.p_D.allFinite());
      EXPECT_GE(place.s, 0.0);
      EXPECT_LE(place.s, path->length);
    }
  }
  const std::array<const FocusMotion*, 1> others{&on_point};
  EXPECT_EQ(place_apart(still, silent, others).p_D, still.p_D[0]);
}

}  // namespace
}  // namespace prostm
