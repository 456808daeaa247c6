#include "prostm/contact/skin_contact.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "prostm/core/units.hpp"
#include "prostm/fluid/fluid.hpp"
#include "prostm/fluid/fluid_pressure.hpp"
#include "prostm/pipeline/smoke/scene.hpp"
#include "prostm/track/hand_source.hpp"
#include "support/heap_guard.hpp"

namespace prostm {
namespace {

constexpr double kStep = 0.02;
#ifdef PROSTM_SANITIZED
constexpr int kCells = 32;  // eight times faster than the default
#else
constexpr int kCells = 64;
#endif

/// A scripted hand in smoke, with all stages up to the target.
struct Bench {
  explicit Bench(const ScriptedHandSettings& hand, const std::string& scene = "one-plume",
                 bool filter_on = true, int threads = 2, const ContactSettings& settings = {},
                 int cells = kCells)
      : pool(threads),
        filter(filter_settings(filter_on)),
        source(make_scripted_hand(hand, filter_settings(filter_on))),
        fluid(fluid_settings(cells), scene_from_name(scene).smoke, pool),
        pressure({}, fluid.grid()),
        rasteriser(fluid.grid()),
        contact(settings, fluid.grid()) {}

  static FluidSettings fluid_settings(int cells) {
    FluidSettings s;
    s.cells = cells;
    return s;
  }
  static TrackSettings filter_settings(bool on) {
    TrackSettings s;
    if (on) return s;
    s.smoothing_time = 0.001;  // velocities from adjacent tracker frames
    s.filter_position = s.filter_velocity = 1.0;
    return s;
  }
  void step() {
    time += kStep;
    source->sample(time, hands);
    to_device(default_tracker_pose(), hands);
    filter.apply(kStep, hands);
    rasteriser.rasterise(hands, pool);
    fluid.step(kStep, rasteriser.raster());
  }
  ContactStats extract() {
    pressure.take(fluid.pressure(), fluid.fluid_cells(), kStep);
    return contact.extract(pressure, rasteriser.raster(), hands, target);
  }

  WorkerPool pool;
  HandFilter filter;
  std::unique_ptr<HandSource> source;
  Fluid fluid;
  FluidPressure pressure;
  HandRasteriser rasteriser;
  SkinContact contact;
  HandFrame hands;
  TargetFrame target;
  double time = 0.0;
};

ScriptedHandSettings still_hand() {
  ScriptedHandSettings hand;
  hand.still = true;
  return hand;
}

TEST(SkinContact, PointsLieOnTheSkinAndFaceTheArray) {
  Bench bench(still_hand());
  for (int i = 0; i < 20; ++i) bench.step();
  const ContactStats stats = bench.extract();
  ASSERT_EQ(bench.target.patches.size(), 1u);
  const TargetField& patch = bench.target.patches[0];
  validate(patch);
  EXPECT_GT(static_cast<double>(stats.skin_cells) * patch.cell * patch.cell, 63e-4);
  EXPECT_EQ(stats.joints_outside, 0);

  const HandShape shape(bench.hands.hands[0]);
  const double h = patch.cell;
  int on_skin = 0;
  for (int row = 0; row < patch.rows; ++row) {
    for (int col = 0; col < patch.cols; ++col) {
      const std::size_t c = patch.index(row, col);
      if (patch.skin[c] == 0) continue;
      const Vec2 x = patch.position(row, col);
      const SurfacePoint skin = shape.query(patch.X_DP * Vec3(x.x(), x.y(), patch.height[c]));
      EXPECT_LT(std::abs(skin.distance), 0.5 * h);
      on_skin += skin.normal.z() < 0.5 ? 1 : 0;
    }
  }
  EXPECT_GT(on_skin,
            0.95 * static_cast<double>(stats.skin_cells));  // the array faces the underside only
}

TEST(SkinContact, PlaneAxesFollowTheDevice) {
  ScriptedHandSettings moving;
  Bench bench(moving);
  int patches = 0;
  for (int i = 0; i < 1000; ++i) {
    bench.step();
    if (i % 10 != 0) continue;
    bench.extract();
    for (const TargetField& patch : bench.target.patches) {
      const Eigen::Matrix3d R = patch.X_DP.linear();
      EXPECT_LT((R.transpose() * R - Eigen::Matrix3d::Identity()).norm(), 1e-12);
      EXPECT_GE(R(2, 2), 0.25);  // the normal points away from the array
      EXPECT_NEAR(R(1, 0), -R(0, 2) * R(1, 2) / std::sqrt(1.0 - R(0, 2) * R(0, 2)),
                  1e-12);  // x is D's x axis, projected
      const Vec3 to_origin = patch.X_DP.translation() - bench.fluid.grid().p_DF;
      EXPECT_LT(to_origin.cross(R.col(2)).norm(), 1e-9);  // the origin is the foot of F's
      ++patches;
    }
  }
  EXPECT_GT(patches, 50);
}

/// Returns the cosine of the angle between the exact normal of the skin and the array's direction.
double cosine_of(const HandShape& shape, const Vec3& p_D) {
  constexpr double kNear = 2e-3;  // [m]
  Vec3 gradient;
  for (int a = 0; a < 3; ++a) {
    const Vec3 step = kNear * Vec3::Unit(a);
    gradient[a] = shape.distance(p_D + step) - shape.distance(p_D - step);
  }
  return -gradient.normalized().dot(p_D.normalized());
}

TEST(SkinContact, PressureIsThatOfTheFluidOutsideTheSkin) {
  // fine cells even under sanitizers: on coarse ones the pressure fades nearly everywhere
  Bench bench(still_hand(), "one-plume", true, 2, {}, 64);
  for (int i = 0; i < 150; ++i) bench.step();
  bench.extract();
  const TargetField& patch = bench.target.patches.at(0);
  const GridShape& grid = bench.fluid.grid();
  const auto pressure = bench.fluid.pressure();
  const auto free = bench.fluid.fluid_cells();
  EXPECT_GT(max_pressure(patch), 0.0);
  const HandShape shape(bench.hands.hands[0]);
  int facing = 0;
  for (int row = 0; row < patch.rows; ++row) {
    for (int col = 0; col < patch.cols; ++col) {
      const std::size_t c = patch.index(row, col);
      if (patch.skin[c] == 0) {
        EXPECT_EQ(patch.pressure[c], 0.0);
        continue;
      }
      // a clamped weighted mean of the eight cells around the sampling point lies between their
      // extremes
      const Vec2 x = patch.position(row, col);
      const Vec3 skin = patch.X_DP * Vec3(x.x(), x.y(), patch.height[c]);
      const Vec3 p = skin - grid.cell * patch.X_DP.linear().col(2);
      const Vec3 q = (p - grid.p_DF) / grid.cell - Vec3::Constant(0.5);
      double low = 1e9, high = -1e9;
      for (int corner = 0; corner < 8; ++corner) {
        const int i = static_cast<int>(std::floor(q.x())) + (corner & 1),
                  j = static_cast<int>(std::floor(q.y())) + (corner >> 1 & 1),
                  k = static_cast<int>(std::floor(q.z())) + (corner >> 2);
        const std::size_t cell = grid.cell_index(i, j, k);
        if (free[cell] == 0) continue;
        low = std::min(low, static_cast<double>(pressure[cell]));
        high = std::max(high, static_cast<double>(pressure[cell]));
      }
      if (high < low) continue;
      EXPECT_LE(patch.pressure[c], std::max(high, 0.0) + 1e-9);
      // skin steeper than 40° fades; so may cells that contain such skin
      if (cosine_of(shape, skin) < std::cos(20 * kPi / 180)) continue;
      EXPECT_GE(patch.pressure[c], std::max(low, 0.0) - 1e-9);
      ++facing;
    }
  }
  EXPECT_GT(facing, 100);
}

TEST(SkinContact, TwoHandsGiveTwoPatches) {
  Bench bench(still_hand());
  bench.source->sample(kStep, bench.hands);
  to_device(default_tracker_pose(), bench.hands);
  Hand left = bench.hands.hands[0], right = left;
  left.id = 1;
  right.id = 2;
  for (int j = 0; j < kJointCount; ++j) {
    left.position[static_cast<std::size_t>(j)] += Vec3(-0.07, 0, 0);
    right.position[static_cast<std::size_t>(j)] += Vec3(0.07, 0, 0.02);
  }
  bench.hands.hands.clear();
  bench.hands.hands.push_back(left);
  bench.hands.hands.push_back(right);
  bench.rasteriser.rasterise(bench.hands, bench.pool);
  bench.fluid.step(kStep, bench.rasteriser.raster());
  bench.extract();
  ASSERT_EQ(bench.target.patches.size(), 2u);
  const HandShape shapes[2] = {HandShape(left), HandShape(right)};
  for (int hand = 0; hand < 2; ++hand) {
    const TargetField& patch = bench.target.patches[static_cast<std::size_t>(hand)];
    for (int row = 0; row < patch.rows; ++row) {
      for (int col = 0; col < patch.cols; ++col) {
        const std::size_t c = patch.index(row, col);
        if (patch.skin[c] == 0) continue;
        const Vec2 x = patch.position(row, col);
        const Vec3 p = patch.X_DP * Vec3(x.x(), x.y(), patch.height[c]);
        EXPECT_LE(shapes[hand].distance(p), shapes[1 - hand].distance(p) + 1e-9);
      }
    }
  }
}

/// Adds a second hand to the scripted one, with its fingers between those of the first.
void interlock(Bench& bench, double time) {
  bench.source->sample(time, bench.hands);
  to_device(default_tracker_pose(), bench.hands);
  Hand other = bench.hands.hands.at(0);
  ++other.id;
  for (Vec3& p : other.position) p += Vec3(0.012, 0, 0.02);
  bench.hands.hands.push_back(other);
  bench.rasteriser.rasterise(bench.hands, bench.pool);
  bench.fluid.step(kStep, bench.rasteriser.raster());
}

/// The skin of a hand in a patch's raster, with every ray marched and every point queried directly.
struct PlainSkin {
  int cells = 0;      // including steep cells
  int differing = 0;  // cells whose skin lies elsewhere than in the patch
};
PlainSkin plain_skin(const Bench& bench, const std::vector<HandShape>& shapes, int hand) {
  const HandRaster& raster = bench.rasteriser.raster();
  const GridShape& g = raster.grid;
  const TargetField& patch = bench.target.patches.at(static_cast<std::size_t>(hand));
  const Vec3 normal = patch.X_DP.linear().col(2);
  double lowest = 1e9, highest = -1e9;
  for (int j = 0; j < g.ny; ++j) {
    for (int i = 0; i < g.nx; ++i) {
      const Vec3 foot = g.cell_centre(i, j, 0) - Vec3(0, 0, 0.5 * g.cell);
      const double t = march(raster, foot, Vec3::UnitZ(), g.nz * g.cell);
      const Vec3 p = foot + Vec3(0, 0, t);
      if (t < 0.0 || nearest_hand(shapes, p) != hand) continue;
      const double z = normal.dot(p - patch.X_DP.translation());
      lowest = std::min(lowest, z);
      highest = std::max(highest, z);
    }
  }
  lowest -= 1.5 * g.cell;
  PlainSkin plain;
  for (int row = 0; row < patch.rows; ++row) {
    for (int col = 0; col < patch.cols; ++col) {
      const Vec2 x = patch.position(row, col);
      const Vec3 start = patch.X_DP * Vec3(x.x(), x.y(), lowest);
      const double t = march(raster, start, normal, highest - lowest + 0.5 * g.cell);
      const bool skin = t >= 0.0 && nearest_hand(shapes, start + t * normal) == hand;
      const std::size_t c = patch.index(row, col);
      const bool same = skin && std::abs(patch.height[c] - (lowest + t)) < 1e-9;
      plain.cells += skin ? 1 : 0;
      plain.differing += patch.skin[c] == 0 || same ? 0 : 1;
    }
  }
  return plain;
}

TEST(SkinContact, MatchesThePlainMarchForInterlockedHands) {
  Bench bench(still_hand());
  for (const double time : {7.0, 9.0, 11.0}) {
    interlock(bench, time);
    const ContactStats stats = bench.extract();
    EXPECT_GT(stats.skin_cells, 100);
    ASSERT_EQ(bench.target.patches.size(), 2u);
    const std::vector<HandShape> shapes = {HandShape(bench.hands.hands[0]),
                                           HandShape(bench.hands.hands[1])};
    const PlainSkin first = plain_skin(bench, shapes, 0), second = plain_skin(bench, shapes, 1);
    EXPECT_EQ(first.differing, 0);
    EXPECT_EQ(second.differing, 0);
    EXPECT_EQ(first.cells + second.cells, stats.skin_cells + stats.steep_cells);
  }
}

TEST(SkinContact, DoesNotDependOnTheThreadsAndDoesNotAllocate) {
  Bench one(still_hand(), "one-plume", true, 1), three(still_hand(), "one-plume", true, 3);
  for (int i = 0; i < 5; ++i) {
    for (Bench* bench : {&one, &three}) {
      interlock(*bench, 9.0 + i * kStep);
      const test::HeapGuard guard;
      bench->extract();
      if (i > 3) {  // the patches have reached their final size
        EXPECT_EQ(guard.allocations(), 0u);
      }
    }
    ASSERT_EQ(one.target.patches.size(), three.target.patches.size());
    for (std::size_t n = 0; n < one.target.patches.size(); ++n) {
      const TargetField &a = one.target.patches[n], &b = three.target.patches[n];
      EXPECT_EQ(a.pressure, b.pressure);
      EXPECT_EQ(a.height, b.height);
      EXPECT_EQ(a.skin, b.skin);
      EXPECT_EQ(a.X_DP.matrix(), b.X_DP.matrix());
    }
  }
}

TEST(SkinContact, SkinHasTheWeightOfItsPartOfTheHand) {
  ContactSettings finer;
  finer.touch_finger = 3.0;
  finer.touch_tip = 7.0;
  Bench bench(still_hand(), "one-plume", true, 2, finer);
  for (int i = 0; i < 5; ++i) {
    interlock(bench, 9.0 + i * kStep);
    const test::HeapGuard guard;
    bench.extract();
    if (i > 3) {  // the patches have reached their final size
      EXPECT_EQ(guard.allocations(), 0u);
    }
  }
  ASSERT_EQ(bench.target.patches.size(), 2u);
  for (std::size_t n = 0; n < 2; ++n) {
    const TargetField& patch = bench.target.patches[n];
    const HandShape shape(bench.hands.hands[n]);
    validate(patch);
    ASSERT_EQ(patch.weight.size(), patch.size());
    int tips = 0, fingers = 0, palm = 0;
    for (int row = 0; row < patch.rows; ++row) {
      for (int col = 0; col < patch.cols; ++col) {
        const std::size_t c = patch.index(row, col);
        const double w = patch.weight[c];
        if (patch.skin[c] == 0) {
          EXPECT_EQ(w, 0.0);
          continue;
        }
        const Vec2 x = patch.position(row, col);
        const SkinRegion region = shape.region(patch.X_DP * Vec3(x.x(), x.y(), patch.height[c]));
        EXPECT_EQ(w, region == SkinRegion::Tip ? 7.0 : region == SkinRegion::Finger ? 3.0 : 1.0);
        tips += w == 7.0 ? 1 : 0;
        fingers += w == 3.0 ? 1 : 0;
        palm += w == 1.0 ? 1 : 0;
      }
    }
    EXPECT_GT(tips, 0);  // few on the coarser grid of sanitizer builds
    EXPECT_GT(fingers, tips);
    EXPECT_GT(palm, 0);  // few on a tilted hand
  }
}

TEST(SkinContact, PatchesHaveNoWeightsIfAllPartsWeighTheSame) {
  ContactSettings same;
  same.touch_palm = same.touch_finger = same.touch_tip = 5.0;
  for (const ContactSettings& settings : {ContactSettings{}, same}) {
    Bench bench(still_hand(), "one-plume", true, 2, settings);
    bench.step();
    bench.extract();
    EXPECT_TRUE(bench.target.patches.at(0).weight.empty());
  }
}

TEST(SkinContact, AHandOutsideTheBoxHasNoTargetAndIsCounted) {
  Bench bench(still_hand());
  bench.source->sample(kStep, bench.hands);
  to_device(default_tracker_pose(), bench.hands);
  for (Vec3& p : bench.hands.hands[0].position) p += Vec3(0.6, 0, 0);
  bench.rasteriser.rasterise(bench.hands, bench.pool);
  bench.fluid.step(kStep, bench.rasteriser.raster());
  const ContactStats stats = bench.extract();
  EXPECT_TRUE(bench.target.patches.empty());
  EXPECT_EQ(stats.joints_outside, static_cast<int>(kJointCount));
}

TEST(SkinContact, WithoutAHandThereIsNoPatch) {
  Bench bench(still_hand());
  bench.hands.hands.clear();
  bench.rasteriser.rasterise(bench.hands, bench.pool);
  bench.fluid.step(kStep, bench.rasteriser.raster());
  EXPECT_EQ(bench.extract().skin_cells, 0);
  EXPECT_TRUE(bench.target.patches.empty());
}

/// Returns the rms change of the target between updates at 25 Hz, relative to its rms, for a hand
/// that is held still.
double flicker(double jitter, bool filter_on) {
  ScriptedHandSettings hand = still_hand();
  hand.jitter = jitter;
  Bench bench(hand, "one-plume", filter_on);
  std::vector<double> last;
  double change = 0.0, power = 0.0;
  for (int i = 0; i < 300; ++i) {
    bench.step();
    if (i < 150 || i % 2 != 0) continue;
    bench.extract();
    const TargetField& patch = bench.target.patches.at(0);
    // compares columns fixed to the device, whose middles lie near the plane's cells
    std::vector<double> now(static_cast<std::size_t>(kCells) * kCells, 0.0);
    for (int row = 0; row < patch.rows; ++row) {
      for (int col = 0; col < patch.cols; ++col) {
        const std::size_t c = patch.index(row, col);
        const Vec2 x = patch.position(row, col);
        const Vec3 q =
            (patch.X_DP * Vec3(x.x(), x.y(), patch.height[c]) - bench.fluid.grid().p_DF) /
                bench.fluid.grid().cell +
            Vec3::Constant(0.5);
        if (patch.skin[c] == 0 || q.x() < 0 || q.y() < 0 || q.x() >= kCells || q.y() >= kCells)
          continue;
        now[static_cast<std::size_t>(q.y()) * kCells + static_cast<std::size_t>(q.x())] =
            patch.pressure[c];
      }
    }
    if (!last.empty()) {
      for (std::size_t c = 0; c < now.size(); ++c) {
        change += (now[c] - last[c]) * (now[c] - last[c]);
        power += now[c] * now[c];
      }
    }
    last = now;
  }
  return std::sqrt(change / power);
}

TEST(SkinContact, TrackerNoiseHardlyChangesTheTarget) {
  const double filtered = flicker(0.3e-3, true), unfiltered = flicker(0.3e-3, false),
               quiet = flicker(0.0, true);
  RecordProperty("filtered_percent", static_cast<int>(100 * filtered));
  RecordProperty("unfiltered_percent", static_cast<int>(100 * unfiltered));
  RecordProperty("no_noise_percent", static_cast<int>(100 * quiet));
  std::printf(
      "frame-to-frame change of the target, a still hand with 0.3 mm of noise: %.0f %% filtered, "
      "%.0f %% unfiltered, %.0f %% without noise\n",
      100 * filtered, 100 * unfiltered, 100 * quiet);
  EXPECT_LE(filtered, 0.30);
  EXPECT_GT(unfiltered, 2.0 * filtered);  // the effect of the filter
}

TEST(SkinContact, RejectsBadSettings) {
  const GridShape grid{32, 32, 32, 0.01, Vec3::Zero()};
  ContactSettings s;
  for (double ContactSettings::*touch :
       {&ContactSettings::touch_palm, &ContactSettings::touch_finger,
        &ContactSettings::touch_tip}) {
    s = {};
    s.*touch = 0.0;
    EXPECT_THROW(SkinContact(s, grid), std::invalid_argument);
  }
}

}  // namespace
}  // namespace prostm
