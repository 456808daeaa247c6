/// Arrays of several parts: placing transducers, and results that do not depend on the placement.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "prostm/acoustics/array/array.hpp"
#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"

namespace prostm {
namespace {

using testing::HasSubstr;

Vec3 random_vector(Random& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

Pose random_pose(Random& random) {
  const Quat turn(random.normal(), random.normal(), random.normal(), random.normal());
  return Eigen::Translation3d(random_vector(random, 0.5)) * turn.normalized();
}

std::string refusal(const std::function<void()>& call) {
  try {
    call();
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "not refused";
}

TEST(Arrays, Autd3IsAGridWithoutThreeTransducers) {
  const TransducerArray array = autd3_array();
  ASSERT_EQ(array.position.size(), 249u);
  ASSERT_EQ(array.normal.size(), 249u);
  EXPECT_NO_THROW(validate(array));
  const double pitch = 10.16e-3;
  // in multiples of the pitch from transducer 0, which is AUTD3's own origin
  const auto steps = [&](std::size_t i) -> Vec3 {
    return (array.position[i] - array.position[0]) / pitch;
  };
  EXPECT_LT((steps(17) - Vec3(17, 0, 0)).norm(), 1e-9);
  EXPECT_LT((steps(18) - Vec3(0, 1, 0)).norm(), 1e-9);
  EXPECT_LT((steps(19) - Vec3(3, 1, 0)).norm(), 1e-9);  // x = 1 and 2 are missing
  EXPECT_LT((steps(31) - Vec3(15, 1, 0)).norm(), 1e-9);
  EXPECT_LT((steps(32) - Vec3(17, 1, 0)).norm(), 1e-9);  // x = 16 is missing
  EXPECT_LT((steps(33) - Vec3(0, 2, 0)).norm(), 1e-9);
  EXPECT_LT((steps(248) - Vec3(17, 13, 0)).norm(), 1e-9);
  EXPECT_LT((array.position[0] + array.position[248]).norm(), 1e-12);  // centred
  const Vec3 above = array.position[100] + Vec3(0.0, 0.0, 0.2);
  EXPECT_NEAR(std::abs(propagate(array, Wave{700.0, 0.0}, 100, above)), 4.386 / 0.2, 1e-12);
}

// The field in the array's frame does not depend on the array's pose.
TEST(Arrays, TheFieldMovesWithTheArray) {
  Random random(21);
  const Medium air;
  for (const TransducerArray& array : {usx_array(), autd3_array()}) {
    for (int trial = 0; trial < 200; ++trial) {
      const Pose X_DA = random_pose(random);
      const TransducerArray placed = place(array, X_DA);
      const Vec3 p_A = random_vector(random, 0.2) + Vec3(0.0, 0.0, 0.3);
      const auto i =
          static_cast<std::size_t>(random.below(static_cast<int>(array.position.size())));
      const std::complex<double> expected = propagate(array, air, i, p_A);
      EXPECT_LT(std::abs(propagate(placed, air, i, X_DA * p_A) - expected), 1e-9);
    }
  }
}

TEST(Arrays, PosesComposeAndKeepUnitNormals) {
  Random random(22);
  const TransducerArray array = autd3_array();
  for (int trial = 0; trial < 50; ++trial) {
    const Pose a = random_pose(random), b = random_pose(random);
    const TransducerArray twice = place(place(array, a), b), once = place(array, b * a);
    for (std::size_t i = 0; i < array.position.size(); ++i) {
      EXPECT_LT((twice.position[i] - once.position[i]).norm(), 1e-12);
      EXPECT_LT((twice.normal[i] - once.normal[i]).norm(), 1e-12);
      EXPECT_NEAR(once.normal[i].norm(), 1.0, 1e-15);
    }
    EXPECT_NO_THROW(validate(once));
  }
}

// Source i and receiver j, both with their directivities, can be exchanged.
TEST(Arrays, SourceAndReceiverCanBeExchanged) {
  Random random(23);
  const Medium air;
  for (const Directivity kind : {Directivity::Piston, Directivity::T4010A1, Directivity::Omni}) {
    TransducerArray pair;
    pair.directivity = kind;
    pair.amplitude = 1.0;
    for (int trial = 0; trial < 500; ++trial) {
      const Pose a = random_pose(random), b = random_pose(random);
      pair.position = {a.translation(), b.translation()};
      pair.normal = {a * Vec3::UnitZ() - a.translation(), b * Vec3::UnitZ() - b.translation()};
      const double ka = wave(pair, air).number * pair.radius;
      const Vec3 way = (pair.position[1] - pair.position[0]).normalized();
      const double heard_at_1 = directivity(kind, ka, -way.dot(pair.normal[1]));
      const double heard_at_0 = directivity(kind, ka, way.dot(pair.normal[0]));
      const std::complex<double> there = propagate(pair, air, 0, pair.position[1]) * heard_at_1;
      const std::complex<double> back = propagate(pair, air, 1, pair.position[0]) * heard_at_0;
      EXPECT_LT(std::abs(there - back), 1e-9 * (1.0 + std::abs(there)));
    }
  }
}

TEST(Arrays, BehindATransducerThePressureIsZero) {
  const Medium air;
  const TransducerArray up = usx_array();
  const Pose over(Eigen::Translation3d(0.0, 0.0, 0.4) *
                  Eigen::AngleAxisd(kPi, Vec3::UnitX()));  // facing down
  const TransducerArray down = place(up, over);
  const Vec3 between(0.01, 0.02, 0.2), below(0.01, 0.02, -0.1), above(0.01, 0.02, 0.5);
  for (std::size_t i = 0; i < up.position.size(); ++i) {
    EXPECT_GT(std::abs(propagate(up, air, i, between)), 0.0);
    EXPECT_GT(std::abs(propagate(down, air, i, between)), 0.0);
    EXPECT_EQ(std::abs(propagate(up, air, i, below)), 0.0);
    EXPECT_EQ(std::abs(propagate(down, air, i, above)), 0.0);
  }
}

// Two arrays that face each other focus together: the amplitudes at the focus add up.
TEST(Arrays, JoinedArraysFocusTogether) {
  const Medium air;
  const TransducerArray one = autd3_array();
  const Pose beside(Eigen::Translation3d(0.2, 0.0, 0.05) * Eigen::AngleAxisd(-0.5, Vec3::UnitY()));
  const std::vector<TransducerArray> parts{one, place(one, beside)};
  const TransducerArray both = join(parts);
  ASSERT_EQ(both.position.size(), 498u);
  EXPECT_EQ(both.name, "autd3 + autd3");
  EXPECT_EQ(both.position[249], parts[1].position[0]);
  EXPECT_EQ(both.normal[497], parts[1].normal[248]);
  EXPECT_NO_THROW(validate(both));
  const Vec3 focus(0.07, 0.01, 0.22);
  const auto focused = [&](const TransducerArray& array) {
    std::vector<double> phases(array.position.size());
    focus_phases(array, air, focus, phases);
    std::complex<double> sum = 0.0;
    for (std::size_t i = 0; i < phases.size(); ++i) {
      sum += std::polar(1.0, phases[i]) * propagate(array, air, i, focus);
    }
    return std::abs(sum);
  };
  EXPECT_NEAR(focused(both), focused(parts[0]) + focused(parts[1]), 1e-8);
}

TEST(Arrays, JoinRejectsArraysThatCannotShareADrive) {
  const TransducerArray autd3 = autd3_array();
  const auto joined_with = [&](const std::function<void(TransducerArray&)>& change) {
    TransducerArray other = autd3;
    other.name = "other";
    change(other);
    return refusal([&] { join(std::vector<TransducerArray>{autd3, other}); });
  };
  EXPECT_EQ(joined_with([](auto&) {}), "not refused");
  EXPECT_EQ(
      joined_with([](auto& a) { a.frequency = 25e3; }),
      "the arrays \"autd3\" and \"other\" differ in frequency; joined arrays must have the same");
  EXPECT_THAT(joined_with([](auto& a) { a.directivity = Directivity::Omni; }),
              HasSubstr("differ in directivity"));
  EXPECT_THAT(joined_with([](auto& a) { a.radius = 5e-3; }), HasSubstr("differ in radius"));
  EXPECT_THAT(joined_with([](auto& a) { a.amplitude_high = 5.0; }),
              HasSubstr("differ in amplitude"));
  EXPECT_THAT(refusal([] { join({}); }), HasSubstr("at least one"));
}

TEST(Arrays, PlaceRejectsInvalidPoses) {
  const TransducerArray array = usx_array();
  Pose stretched = Pose::Identity(), mirrored = stretched, lost = stretched, far = stretched;
  stretched.linear() *= 1.001;
  mirrored.linear()(0, 0) = -1.0;
  lost.translation().x() = std::numeric_limits<double>::quiet_NaN();
  far.translation().y() = std::numeric_limits<double>::infinity();
  for (const Pose& pose : {stretched, mirrored, lost, far}) {
    EXPECT_THAT(refusal([&] { place(array, pose); }), HasSubstr("a rotation and a translation"));
  }
}

TEST(Arrays, ValidateReportsTheFault) {
  const auto changed = [](const std::function<void(TransducerArray&)>& change) {
    TransducerArray array = usx_array();
    change(array);
    return refusal([&] { validate(array); });
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(changed([](auto&) {}), "not refused");
  EXPECT_THAT(changed([](auto& a) { a.position.clear(); }), HasSubstr("has 0 transducers"));
  EXPECT_THAT(changed([](auto& a) { a.position.resize(4097, Vec3::Zero()); }),
              HasSubstr("has 4097 transducers; it must have from 1 to 4096"));
  EXPECT_THAT(changed([](auto& a) { a.normal.pop_back(); }), HasSubstr("has 255 normals"));
  EXPECT_THAT(changed([&](auto& a) { a.position[7].y() = nan; }),
              HasSubstr("coordinate of transducer 7 (from 0) = nan m must be between"));
  EXPECT_THAT(changed([&](auto& a) { a.normal[3].z() = nan; }),
              HasSubstr("normal of transducer 3 (from 0) = nan must be between"));
  EXPECT_THAT(changed([](auto& a) { a.normal[3].z() = 0.9; }),
              HasSubstr("length of the normal of transducer 3 (from 0) = 0.9 must be"));
  EXPECT_THAT(changed([](auto& a) { a.position[200] = a.position[9] + Vec3(5e-5, 5e-5, 0); }),
              HasSubstr("transducers 9 and 200 (from 0) are at the same place"));
  EXPECT_THAT(changed([](auto& a) { a.frequency = 19e3; }), HasSubstr("frequency = 19000 Hz"));
  EXPECT_THAT(changed([](auto& a) { a.radius = 0.0; }), HasSubstr("radius = 0 m"));
  EXPECT_THAT(changed([](auto& a) { a.amplitude = 0.0; }), HasSubstr("amplitude = 0 Pa·m"));
  EXPECT_THAT(changed([](auto& a) { a.amplitude_low = 4.0; }), HasSubstr("amplitude_low = 4"));
  EXPECT_THAT(changed([](auto& a) { a.amplitude_high = 3.0; }), HasSubstr("amplitude_high = 3"));
}

}  // namespace
}  // namespace prostm
