#include "prostm/hand/detail/body_set.hpp"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "prostm/core/random.hpp"
#include "support/only_targets.hpp"

namespace prostm {
namespace {

const Vec3 kOrigin(0.02, -0.01, 0.18);

Vec3 random_vector(Random& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

CornerSphere random_corner(Random& random) {
  return {kOrigin + random_vector(random, 0.05), random.uniform(0.003, 0.03),
          random_vector(random, 1.0)};
}

/// Returns the corners of a body; every kind except the first is degenerate.
std::array<CornerSphere, 3> corners_of_kind(int kind, Random& random) {
  CornerSphere a = random_corner(random), b = random_corner(random), c = random_corner(random);
  const Vec3 ab = b.centre - a.centre;
  const double u = random.uniform(-0.5, 1.5);
  switch (kind) {
    case 1:  // equal radii
      b.radius = c.radius = a.radius;
      break;
    case 2:  // one sphere in another
      b.centre =
          a.centre + random.uniform(0.0, 0.9) * std::abs(a.radius - b.radius) * ab.normalized();
      break;
    case 3:  // one sphere touching another from within, or nearly so
      b.centre = a.centre + (1.0 + random.uniform(-1e-6, 1e-6)) * std::abs(a.radius - b.radius) *
                                ab.normalized();
      break;
    case 4:  // corners in line
      c.centre = a.centre + u * ab;
      break;
    case 5:  // a flat triangle, thin beyond single precision or nearly so
      c.centre = a.centre + u * ab +
                 std::pow(10.0, random.uniform(-9.0, -2.0)) * random_vector(random, 0.05);
      break;
    case 6:  // two equal corners
      c = b;
      break;
    case 7:  // three equal corners
      b = c = a;
      break;
    case 8:  // the third is nearly hidden in the hull of the others
      c.centre = a.centre + 0.5 * ab +
                 std::abs(0.5 * (a.radius + b.radius) - c.radius) *
                     (1.0 + random.uniform(-1e-6, 1e-6)) * ab.unitOrthogonal();
      break;
    default:
      break;
  }
  return {a, b, c};
}
constexpr int kKinds = 9;

CubeCorners random_cube(Random& random) {
  const Vec3 centre = random_vector(random, 0.08);
  CubeCorners corners{};
  for (int a = 0; a < 3; ++a) corners.centre[a] = static_cast<float>(centre[a]);
  corners.half = static_cast<float>(random.uniform(0.001, 0.02));
  return corners;
}

Vec3 point(const CubeCorners& corners, unsigned c) {
  Vec3 p = kOrigin;
  for (unsigned a = 0; a < 3; ++a) {
    p[a] += static_cast<double>(corners.centre[a]) +
            ((c >> a & 1U) != 0 ? 1.0 : -1.0) * static_cast<double>(corners.half);
  }
  return p;
}

BodyList every_body(const BodySet& bodies) {
  BodyList list;
  while (list.count < static_cast<int>(bodies.size())) {
    list.body[list.count] = static_cast<std::uint8_t>(list.count);
    ++list.count;
  }
  return list;
}

struct Errors {
  double distance = 0.0, velocity = 0.0;
  int velocities = 0;
};

/// Compares the vector kernels for one body with the body's own functions.
template <class Body>
void compare(const Body& body, int cubes, Random& random, Errors& errors) {
  BodySet bodies;
  bodies.clear(kOrigin);
  bodies.add(body);
  const BodyList list = every_body(bodies);
  for (int n = 0; n < cubes; ++n) {
    const CubeCorners cube = random_cube(random);
    NearestBodies nearest;
    fast_body_kernels().nearest(bodies, list, cube, nearest);
    alignas(32) float v[3][8];
    fast_body_kernels().velocity(bodies, nearest, cube, 0xff, v);
    for (unsigned c = 0; c < 8; ++c) {
      const SurfacePoint expected = body.query(point(cube, c));
      const double found = static_cast<double>(nearest.distance[c]);
      errors.distance = std::max(errors.distance, std::abs(found - expected.distance));
      // deep inside, the nearest skin point jumps from one side to the other
      if (expected.distance < -0.002) continue;
      const Vec3 velocity = Eigen::Vector3f(v[0][c], v[1][c], v[2][c]).cast<double>();
      errors.velocity = std::max(errors.velocity, (velocity - expected.velocity).norm());
      ++errors.velocities;
    }
  }
}

/// Runs f with each vector target of this processor, the widest last.
template <class F>
void with_each_target(F&& f) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    const test::OnlyTargets only(target);
    SCOPED_TRACE(hwy::TargetName(target));
    f();
  }
}

TEST(BodyKernels, VectorsAgreeWithTheBodies) {
  with_each_target([] {
    Random random(11);
    for (int kind = 0; kind < kKinds; ++kind) {
      Errors cone, triangle;
      for (int n = 0; n < 400; ++n) {
        const auto [a, b, c] = corners_of_kind(kind, random);
        compare(RoundCone(a, b), 5, random, cone);
        compare(SphereTriangle(a, b, c), 5, random, triangle);
      }
      // a point in single precision is accurate only to a few nanometres
      EXPECT_LT(cone.distance, 1e-7) << "kind " << kind;
      EXPECT_LT(triangle.distance, 1e-7) << "kind " << kind;
      EXPECT_GT(triangle.velocities, 10000) << "kind " << kind;
      // along a hidden corner several skin points are equally close
      EXPECT_LT(cone.velocity, 1e-4) << "kind " << kind;
      EXPECT_LT(triangle.velocity, kind == 8 ? 0.1 : 5e-3) << "kind " << kind;
    }
  });
}

/// Bodies of all kinds in one set.
class MixedBodies {
 public:
  explicit MixedBodies(Random& random) {
    set.clear(kOrigin);
    for (std::size_t n = 0; n < kEach; ++n) {
      const auto [a, b, c] = corners_of_kind(static_cast<int>(n) % kKinds, random);
      cones_[n] = RoundCone(a, b);
      triangles_[n] = SphereTriangle(c, a, b);
      set.add(cones_[n]);
      set.add(triangles_[n]);
    }
  }
  double distance(std::size_t body, const Vec3& p) const {
    return body % 2 == 0 ? cones_[body / 2].distance(p) : triangles_[body / 2].distance(p);
  }
  BodySet set;

 private:
  static constexpr std::size_t kEach = 12;
  std::array<RoundCone, kEach> cones_;
  std::array<SphereTriangle, kEach> triangles_;
};

TEST(BodyKernels, VectorsFindTheNearestOfManyAsPlainCodeDoes) {
  with_each_target([] {
    Random random(12);
    for (int n = 0; n < 300; ++n) {
      const MixedBodies bodies(random);
      const BodyList list = every_body(bodies.set);
      const CubeCorners cube = random_cube(random);
      NearestBodies plain, fast;
      scalar_body_kernels().nearest(bodies.set, list, cube, plain);
      fast_body_kernels().nearest(bodies.set, list, cube, fast);
      for (unsigned c = 0; c < 8; ++c) {
        EXPECT_NEAR(fast.distance[c], plain.distance[c], 1e-7F);
        // if two bodies are equally close, either may be chosen
        const auto body = static_cast<std::size_t>(fast.body[c]);
        EXPECT_NEAR(bodies.distance(body, point(cube, c)), static_cast<double>(plain.distance[c]),
                    1e-7);
      }
    }
  });
}

TEST(BodyKernels, CullingKeepsEveryBodyThatIsNearestSomewhere) {
  const auto check = [] {
    Random random(13);
    int kept = 0, dropped = 0;
    for (int n = 0; n < 100; ++n) {
      const MixedBodies bodies(random);
      const BodyList list = every_body(bodies.set);
      const CubeCorners cube = random_cube(random);
      const double reach = random.uniform(0.001, 0.01), limit = random.uniform(0.0, 0.02);
      std::uint8_t near[2][BodySet::kCapacity];
      const BodyKernels* kernels[2] = {&scalar_body_kernels(), &fast_body_kernels()};
      for (int kind = 0; kind < 2; ++kind) {
        kernels[kind]->cull(bodies.set, list, cube, static_cast<float>(reach + 1e-6),
                            static_cast<float>(limit), near[kind]);
        for (int b = 0; b < list.count; ++b) {
          kept += std::popcount(near[kind][b]);
          dropped += 8 - std::popcount(near[kind][b]);
        }
      }
      for (int i = 0; i < 200; ++i) {
        const unsigned c = static_cast<unsigned>(i) % 8;
        const Vec3 p =
            point(cube, c) + random.uniform(0.0, reach) * random_vector(random, 1.0).normalized();
        std::size_t best = 0;
        for (std::size_t b = 1; b < bodies.set.size(); ++b) {
          if (bodies.distance(b, p) < bodies.distance(best, p)) best = b;
        }
        if (bodies.distance(best, p) > limit) continue;
        EXPECT_NE(near[0][best] >> c & 1, 0);
        EXPECT_NE(near[1][best] >> c & 1, 0);
      }
    }
    EXPECT_GT(kept, 100);
    EXPECT_GT(dropped, 100);
  };
  with_each_target(check);
}

TEST(BodyKernels, PlainVelocitiesEqualTheBodiesOwn) {
  Random random(14);
  const MixedBodies bodies(random);
  const CubeCorners cube = random_cube(random);
  NearestBodies nearest;
  scalar_body_kernels().nearest(bodies.set, every_body(bodies.set), cube, nearest);
  float v[3][8] = {};
  scalar_body_kernels().velocity(bodies.set, nearest, cube, 0xfd, v);
  for (unsigned c = 0; c < 8; ++c) {
    const BodySet::Body& body = bodies.set[static_cast<std::size_t>(nearest.body[c])];
    const Vec3 p = point(cube, c);
    Vec3 expected =
        body.cone != nullptr ? body.cone->query(p).velocity : body.triangle->query(p).velocity;
    if (c == 1) expected.setZero();  // not requested
    for (std::size_t a = 0; a < 3; ++a)
      EXPECT_NEAR(static_cast<double>(v[a][c]), expected[static_cast<int>(a)], 1e-6);
  }
}

}  // namespace
}  // namespace prostm
