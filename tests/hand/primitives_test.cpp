#include "prostm/hand/detail/primitives.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "prostm/core/random.hpp"

namespace prostm {
namespace {

Vec3 random_vector(Random& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

CornerSphere random_corner(Random& random) {
  return {random_vector(random, 0.05), random.uniform(0.003, 0.03), random_vector(random, 1.0)};
}

/// Computes min over q of |p − q| − r(q) by sampling the spheres whose hull is the body. This is an
/// upper bound, too large by at most the sample spacing.
double by_samples(const Vec3& p, const CornerSphere& a, const CornerSphere& b,
                  const CornerSphere& c, int n) {
  double nearest = 1e30;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; i + j <= n; ++j) {
      const double u = static_cast<double>(i) / n, v = static_cast<double>(j) / n, w = 1.0 - u - v;
      const Vec3 q = w * a.centre + u * b.centre + v * c.centre;
      nearest = std::min(nearest, (p - q).norm() - (w * a.radius + u * b.radius + v * c.radius));
    }
  }
  return nearest;
}

TEST(RoundCone, OfEqualRadiiIsACapsule) {
  const RoundCone cone({Vec3(0, 0, 0), 0.01, {}}, {Vec3(0.1, 0, 0), 0.01, {}});
  EXPECT_NEAR(cone.distance(Vec3(0.05, 0.03, 0.0)), 0.02, 1e-15);
  EXPECT_NEAR(cone.distance(Vec3(0.13, 0.0, 0.04)), 0.04, 1e-15);
  EXPECT_NEAR(cone.distance(Vec3(-0.03, 0.04, 0.0)), 0.04, 1e-15);
  EXPECT_NEAR(cone.distance(Vec3(0.02, 0.0, 0.0)), -0.01, 1e-15);
}

TEST(RoundCone, WithOneSphereInsideTheOtherIsTheLargerSphere) {
  const Vec3 p(0.07, -0.02, 0.05);
  const CornerSphere large{Vec3(0.01, 0, 0), 0.03, Vec3(1, 0, 0)},
      small{Vec3(0.02, 0, 0), 0.01, Vec3(0, 1, 0)};
  const double expected = (p - large.centre).norm() - 0.03;
  for (const RoundCone& cone : {RoundCone(large, small), RoundCone(small, large)}) {
    EXPECT_DOUBLE_EQ(cone.distance(p), expected);
    EXPECT_EQ(cone.query(p).velocity, Vec3(1, 0, 0));
  }
}

TEST(RoundCone, OfZeroLengthIsASphereEvenAtItsCentre) {
  const CornerSphere sphere{Vec3(0.1, 0.2, 0.3), 0.02, Vec3(0, 0, 1)};
  const RoundCone cone(sphere, sphere);
  EXPECT_DOUBLE_EQ(cone.distance(sphere.centre), -0.02);
  const SurfacePoint point = cone.query(sphere.centre);
  EXPECT_NEAR(point.normal.norm(), 1.0, 1e-12);
  EXPECT_DOUBLE_EQ(point.distance, -0.02);
}

TEST(RoundCone, HasAUnitNormalOnItsAxis) {
  const CornerSphere a{Vec3(0, 0, 0), 0.02, {}}, b{Vec3(0, 0.1, 0), 0.01, {}};
  const RoundCone cone(a, b);
  for (const double y : {0.0, 0.03, 0.05, 0.1}) {
    const SurfacePoint point = cone.query(Vec3(0, y, 0));
    EXPECT_NEAR(point.normal.norm(), 1.0, 1e-12);
    EXPECT_LT(point.distance, 0.0);
  }
}

TEST(SphereTriangle, OfEqualRadiiIsAThickTriangle) {
  const CornerSphere a{Vec3(0, 0, 0), 0.01, {}}, b{Vec3(0.1, 0, 0), 0.01, {}},
      c{Vec3(0, 0.1, 0), 0.01, {}};
  const SphereTriangle triangle(a, b, c);
  EXPECT_NEAR(triangle.distance(Vec3(0.02, 0.03, 0.05)), 0.04, 1e-15);
  EXPECT_NEAR(triangle.distance(Vec3(0.02, 0.03, -0.005)), -0.005, 1e-15);
  EXPECT_NEAR(triangle.distance(Vec3(0.02, -0.03, 0.04)), 0.04, 1e-15);
  EXPECT_NEAR(triangle.query(Vec3(0.02, 0.03, 0.05)).normal.z(), 1.0, 1e-12);
  EXPECT_NEAR(triangle.query(Vec3(0.02, 0.03, -0.05)).normal.z(), -1.0, 1e-12);
}

TEST(SphereTriangle, OfCollinearCornersIsTheirRoundCone) {
  const CornerSphere a{Vec3(0, 0, 0), 0.01, {}}, b{Vec3(0.05, 0, 0), 0.015, {}},
      c{Vec3(0.1, 0, 0), 0.02, {}};
  const SphereTriangle triangle(a, b, c), point(a, a, a);
  const RoundCone cone(a, c);
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p = random_vector(random, 0.15);
    EXPECT_NEAR(triangle.distance(p), cone.distance(p), 1e-14);
    EXPECT_NEAR(point.distance(p), p.norm() - 0.01, 1e-14);
  }
}

TEST(Bodies, AgreeWithSamplesOfTheirSpheres) {
  Random random(2);
  constexpr int kSamples = 60;
  for (int n = 0; n < 300; ++n) {
    // small triangles with large radii are degenerate
    CornerSphere a = random_corner(random), b = random_corner(random), c = random_corner(random);
    if (n % 3 == 1) b.centre = a.centre + 0.2 * (b.centre - a.centre);
    if (n % 3 == 2) c.centre = a.centre + random.uniform(0.0, 1.0) * (b.centre - a.centre);
    const double longest = std::max(
        {(b.centre - a.centre).norm(), (c.centre - a.centre).norm(), (c.centre - b.centre).norm()});
    const SphereTriangle triangle(a, b, c);
    const RoundCone cone(a, b);
    for (int i = 0; i < 10; ++i) {
      const Vec3 p = random_vector(random, 0.08);
      const double expected = by_samples(p, a, b, c, kSamples);
      EXPECT_LE(triangle.distance(p), expected + 1e-12);
      EXPECT_GE(triangle.distance(p), expected - 2.0 * longest / kSamples);
      const double on_cone = by_samples(p, a, b, a, kSamples);
      EXPECT_LE(cone.distance(p), on_cone + 1e-12);
      EXPECT_GE(cone.distance(p), on_cone - 2.0 * longest / kSamples);
    }
  }
}

template <class Body>
void expect_gradient_is_normal(const Body& body, const Vec3& p) {
  constexpr double kDelta = 1e-6;
  Vec3 gradient;
  for (int a = 0; a < 3; ++a) {
    const Vec3 d = kDelta * Vec3::Unit(a);
    gradient[a] = (body.distance(p + d) - body.distance(p - d)) / (2 * kDelta);
  }
  const SurfacePoint point = body.query(p);
  EXPECT_NEAR(point.distance, body.distance(p), 1e-12);
  EXPECT_NEAR(point.normal.norm(), 1.0, 1e-12);
  // within a step of a crease the normal belongs to one side, but the difference spans both
  if ((gradient - point.normal).norm() > 1e-4) {
    EXPECT_LT(body.distance(p), 0.0) << "outside a convex body there is no crease";
  }
}

TEST(Bodies, NormalsAreUnitGradients) {
  Random random(3);
  for (int n = 0; n < 300; ++n) {
    const CornerSphere a = random_corner(random), b = random_corner(random),
                       c = random_corner(random);
    const SphereTriangle triangle(a, b, c);
    const RoundCone cone(a, b);
    for (int i = 0; i < 10; ++i) {
      const Vec3 p = random_vector(random, 0.08);
      expect_gradient_is_normal(triangle, p);
      expect_gradient_is_normal(cone, p);
    }
  }
}

TEST(Bodies, ASkinPointMovesWithItsVelocity) {
  // the corners move for a short time: the skin's normal speed is minus the rate of the distance at
  // a fixed point
  Random random(4);
  constexpr double kTime = 1e-7;
  for (int n = 0; n < 500; ++n) {
    CornerSphere corner[3];
    for (CornerSphere& c : corner) c = random_corner(random);
    const SphereTriangle before(corner[0], corner[1], corner[2]);
    const RoundCone cone_before(corner[0], corner[1]);
    for (CornerSphere& c : corner) c.centre += kTime * c.velocity;
    const SphereTriangle after(corner[0], corner[1], corner[2]);
    const RoundCone cone_after(corner[0], corner[1]);
    const Vec3 p = random_vector(random, 0.1);
    const SurfacePoint on_triangle = before.query(p), on_cone = cone_before.query(p);
    if (on_triangle.distance > 0.001) {
      EXPECT_NEAR(on_triangle.velocity.dot(on_triangle.normal),
                  -(after.distance(p) - before.distance(p)) / kTime, 1e-3);
    }
    if (on_cone.distance > 0.001) {
      EXPECT_NEAR(on_cone.velocity.dot(on_cone.normal),
                  -(cone_after.distance(p) - cone_before.distance(p)) / kTime, 1e-3);
    }
  }
}

TEST(Bodies, LieWithinTheirBounds) {
  Random random(5);
  for (int n = 0; n < 200; ++n) {
    const CornerSphere a = random_corner(random), b = random_corner(random),
                       c = random_corner(random);
    const SphereTriangle triangle(a, b, c);
    for (int i = 0; i < 100; ++i) {
      const Vec3 p = random_vector(random, 0.1);
      if (triangle.distance(p) > 0.0) continue;
      EXPECT_TRUE((p.array() >= triangle.lower().array()).all() &&
                  (p.array() <= triangle.upper().array()).all());
    }
  }
}

}  // namespace
}  // namespace prostm
