#include "prostm/acoustics/array/directivity.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"

namespace prostm {
namespace {

double sheet(double degrees) {
  return directivity(Directivity::T4010A1, 3.3, std::cos(degrees * kPi / 180.0));
}

TEST(Directivity, PistonAgreesWithTheBesselSeries) {
  EXPECT_DOUBLE_EQ(piston_directivity(3.3, 0.0), 1.0);
  // 2 J₁(x)/x = Σ (-1)^m (x/2)^{2m} / (m! (m+1)!)
  for (double x = 1e-4; x < 6.0; x *= 1.07) {
    double sum = 0.0, term = 1.0;
    for (int m = 0; m < 60; ++m) {
      sum += term;
      term *= -(x / 2.0) * (x / 2.0) / ((m + 1.0) * (m + 2.0));
    }
    EXPECT_NEAR(piston_directivity(x, 1.0), sum, 1e-12) << "x = " << x;
    EXPECT_DOUBLE_EQ(piston_directivity(x, -1.0), piston_directivity(x, 1.0));
  }
  EXPECT_NEAR(piston_directivity(3.8317059702, 1.0), 0.0, 1e-9);  // first zero of J₁
}

TEST(Directivity, TakesTheCosineOfTheAngle) {
  Random random(1);
  for (int trial = 0; trial < 1000; ++trial) {
    const double ka = random.uniform(0.0, 6.0), theta = random.uniform(0.0, 0.5 * kPi);
    EXPECT_NEAR(directivity(Directivity::Piston, ka, std::cos(theta)),
                piston_directivity(ka, std::sin(theta)), 1e-12);
  }
}

TEST(Directivity, IsOneOnAxisAndZeroBehind) {
  for (const Directivity kind : {Directivity::Piston, Directivity::T4010A1}) {
    EXPECT_DOUBLE_EQ(directivity(kind, 3.3, 1.0), 1.0);
    EXPECT_DOUBLE_EQ(directivity(kind, 3.3, 1.0 + 1e-15), 1.0);
    EXPECT_GT(directivity(kind, 3.3, 1e-9), 0.1);
    for (const double cosine : {-1e-9, -0.5, -1.0, -1.0 - 1e-15}) {
      EXPECT_EQ(directivity(kind, 3.3, cosine), 0.0);
    }
  }
  for (const double cosine : {1.0, 0.3, 0.0, -0.7, -1.0}) {
    EXPECT_EQ(directivity(Directivity::Omni, 3.3, cosine), 1.0);
  }
}

TEST(Directivity, MatchesTheDataSheetEveryTenDegrees) {
  const double values[] = {1, 1, 1, .891, .708, .501, .355, .251, .200, .178};
  for (int i = 0; i < 10; ++i) EXPECT_NEAR(sheet(10.0 * i), values[i], 1e-9) << 10 * i << "°";
  // between the data points, from an independent solution of the spline's equations
  EXPECT_NEAR(sheet(25.0), 0.9591533573806882, 1e-9);
  EXPECT_NEAR(sheet(45.0), 0.6012466981132076, 1e-9);
  EXPECT_NEAR(sheet(85.0), 0.18733412874583796, 1e-9);
}

TEST(Directivity, DataSheetSplineIsSmoothAndNatural) {
  const double h = 0.01;
  const auto slope = [&](double x) { return (sheet(x + h) - sheet(x - h)) / (2.0 * h); };
  const auto bend = [&](double x) {
    return (sheet(x + h) - 2.0 * sheet(x) + sheet(x - h)) / (h * h);
  };
  for (double knot = 10.0; knot < 85.0; knot += 10.0) {
    EXPECT_NEAR(slope(knot + 2.0 * h), slope(knot - 2.0 * h), 2e-4) << knot;
    EXPECT_NEAR(bend(knot + 2.0 * h), bend(knot - 2.0 * h), 2e-4) << knot;
  }
  EXPECT_NEAR(bend(2.0 * h), 0.0, 1e-5);
  EXPECT_NEAR(bend(90.0 - 2.0 * h), 0.0, 1e-5);
  for (double x = 0.0; x <= 90.0; x += 0.1) EXPECT_LT(sheet(x), 1.008);
}

TEST(Directivity, NamesMatchThoseInFiles) {
  EXPECT_STREQ(directivity_name(Directivity::Piston), "piston");
  EXPECT_STREQ(directivity_name(Directivity::T4010A1), "t4010a1");
  EXPECT_STREQ(directivity_name(Directivity::Omni), "omni");
}

}  // namespace
}  // namespace prostm
