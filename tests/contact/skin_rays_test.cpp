#include "prostm/contact/detail/skin_rays.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "prostm/contact/detail/skin_owner.hpp"
#include "prostm/core/random.hpp"
#include "prostm/track/hand_source.hpp"
#include "support/heap_guard.hpp"

namespace prostm {
namespace {

const GridShape kGrid{64, 64, 64, 0.36 / 64, Vec3(-0.18, -0.18, 0.0)};

/// Samples the scripted hand; if `apart` [m] is not 0, adds a second one next to it, 20 mm higher.
HandFrame hands_at(double time, double apart, const Vec3& by = Vec3::Zero()) {
  HandFrame frame;
  make_scripted_hand({}, {})->sample(time, frame);
  to_device(default_tracker_pose(), frame);
  if (frame.hands.empty()) return frame;
  for (Vec3& p : frame.hands[0].position) p += by;
  if (apart == 0.0) return frame;
  Hand other = frame.hands[0];
  ++other.id;
  for (Vec3& p : frame.hands[0].position) p.x() -= 0.5 * apart;
  for (Vec3& p : other.position) p += Vec3(0.5 * apart, 0.0, 0.02);
  frame.hands.push_back(other);
  return frame;
}

/// Hands on the grid and the rays to them.
struct Scene {
  explicit Scene(const HandFrame& frame) : rasteriser(kGrid), rays(kGrid) { show(frame); }
  void show(const HandFrame& frame) {
    rasteriser.rasterise(frame, pool);
    rays.set(rasteriser.raster());
    shapes.clear();
    for (const Hand& hand : frame.hands) shapes.emplace_back(hand);
  }
  const HandRaster& raster() const { return rasteriser.raster(); }

  WorkerPool pool{1};
  HandRasteriser rasteriser;
  SkinRays rays;
  std::vector<HandShape> shapes;
};

Vec3 random_vector(Random& random) {
  return {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)};
}

struct Ray {
  Vec3 start, direction;
};

/// Returns a ray towards a point near a hand, from any direction.
Ray random_ray(const HandShape& shape, Random& random) {
  const Vec3 half = 0.6 * (shape.upper() - shape.lower());
  const Vec3 to = 0.5 * (shape.lower() + shape.upper()) + random_vector(random).cwiseProduct(half);
  const Vec3 direction = (random_vector(random) + Vec3(0, 0, 0.8)).normalized();
  return {to - random.uniform(0.0, 0.15) * direction, direction};
}

/// Returns a ray that is tangent to the skin within a fifth of a millimetre.
Ray grazing_ray(const HandShape& shape, Random& random) {
  Ray ray = random_ray(shape, random);
  Vec3 p = ray.start;
  SurfacePoint skin;
  for (int n = 0; n < 20; ++n) {
    skin = shape.query(p);
    p -= skin.distance * skin.normal;
  }
  ray.direction = skin.normal.cross(ray.direction).normalized();
  ray.start = p + random.uniform(-2e-4, 2e-4) * skin.normal - 0.05 * ray.direction;
  return ray;
}

struct Compared {
  int crossings = 0, misses = 0;
};

void compare(const Scene& scene, const Ray& ray, Compared& count) {
  const double reach = 0.2;
  const double plain = march(scene.raster(), ray.start, ray.direction, reach);
  const double fast = scene.rays.march(ray.start, ray.direction, reach);
  ASSERT_EQ(plain < 0.0, fast < 0.0);
  ASSERT_NEAR(plain, fast, 1e-9);
  ++(plain < 0.0 ? count.misses : count.crossings);
}

TEST(SkinRays, HitTheSkinWhereThePlainMarchDoes) {
  // one hand, two, two interlocked, and two that extend beyond the grid's bottom and side
  const HandFrame frames[] = {hands_at(11.6, 0.0), hands_at(9.0, 0.15), hands_at(7.2, 0.012),
                              hands_at(9.0, 0.1, Vec3(0.13, 0.02, -0.18))};
  Random random(1);
  for (const HandFrame& frame : frames) {
    const Scene scene(frame);
    Compared any, grazing;
    for (int n = 0; n < 6000; ++n) {
      const HandShape& shape = scene.shapes[static_cast<std::size_t>(n) % scene.shapes.size()];
      compare(scene, random_ray(shape, random), any);
      compare(scene, grazing_ray(shape, random), grazing);
      if (HasFatalFailure()) return;
    }
    EXPECT_GT(any.crossings, 1000);
    EXPECT_GT(any.misses, 1000);
    EXPECT_GT(grazing.crossings, 1000);
    EXPECT_GT(grazing.misses, 100);
  }
}

TEST(SkinRays, ColumnsHitTheSkinWhereThePlainMarchDoes) {
  Scene scene(hands_at(11.6, 0.0));
  int crossings = 0;
  // several scenes with the same rays: nothing of an earlier scene may remain
  for (const double apart : {0.15, 0.0, 0.012}) {
    for (const double below : {0.0, 0.1, 0.18}) {
      scene.show(hands_at(9.0, apart, Vec3(0.05, 0.0, -below)));
      const CellBox& box = scene.raster().box;
      const int bottom = std::max(box.lower[2] - 1, 0);
      const double reach = (box.upper[2] - bottom) * kGrid.cell;
      for (int j = 0; j < kGrid.ny; ++j) {
        for (int i = 0; i < kGrid.nx; ++i) {
          Vec3 start = kGrid.cell_centre(i, j, bottom);
          start.z() = kGrid.node(i, j, bottom).z();
          const double t = march(scene.raster(), start, Vec3::UnitZ(), reach);
          const double z = scene.rays.column(i, j);
          ASSERT_EQ(t < 0.0, std::isnan(z)) << i << " " << j;
          if (t < 0.0) continue;
          ASSERT_NEAR(z, start.z() + t, 1e-9);
          ++crossings;
        }
      }
    }
  }
  EXPECT_GT(crossings, 2000);
}

TEST(SkinRays, WithoutAHandThereIsNoSkinAndNoAllocation) {
  Scene scene(hands_at(11.6, 0.15));
  const test::HeapGuard guard;
  scene.rays.set(scene.raster());
  EXPECT_EQ(guard.allocations(), 0u);
  scene.show({});
  scene.show({});  // clears the box of the hand that left
  EXPECT_TRUE(scene.rays.box().empty());
  EXPECT_LT(scene.rays.march(Vec3(0, 0, 0.01), Vec3::UnitZ(), 0.3), 0.0);
}

TEST(SkinOwner, IsTheHandWithTheSmallerDistance) {
  const double near = 0.008;
  for (const double apart : {0.25, 0.1, 0.03, 0.012, 1e-3}) {
    const Scene scene(hands_at(9.0, apart));
    SkinOwner owner;
    owner.set(scene.shapes, near);
    Random random(2);
    int count[2] = {0, 0};
    Vec3 p = Vec3::Zero();
    for (int n = 0; n < 20000; ++n) {
      // sometimes at a new position, otherwise a short distance along the skin
      const HandShape& shape = scene.shapes[static_cast<std::size_t>(n / 40) % 2];
      p = n % 40 == 0 ? random_ray(shape, random).start : Vec3(p + 0.006 * random_vector(random));
      const SurfacePoint skin = shape.query(p);
      p -= (skin.distance - random.uniform(-near, near)) * skin.normal;
      if (std::min(scene.shapes[0].distance(p), scene.shapes[1].distance(p)) > near) continue;
      const int hand = nearest_hand(scene.shapes, p);
      ASSERT_EQ(owner.of(p), hand);
      ++count[hand];
    }
    EXPECT_GT(count[0], 4000);
    EXPECT_GT(count[1], 4000);
  }
}

TEST(SkinOwner, DistanceOfAHandIsThatOfItsNearestBody) {
  const HandShape shape(hands_at(9.0, 0.0).hands[0]);
  Random random(3);
  for (int n = 0; n < 10000; ++n) {
    const Vec3 p = random_ray(shape, random).start;
    double nearest = 1e30;
    for (const RoundCone& cone : shape.cones()) nearest = std::min(nearest, cone.distance(p));
    for (const SphereTriangle& t : shape.triangles()) nearest = std::min(nearest, t.distance(p));
    ASSERT_NEAR(shape.distance(p), nearest, 1e-15);
  }
}

}  // namespace
}  // namespace prostm
