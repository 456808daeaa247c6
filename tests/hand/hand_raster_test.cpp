#include "prostm/hand/hand_raster.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "prostm/track/hand_source.hpp"
#include "support/heap_guard.hpp"

namespace prostm {
namespace {

const GridShape kGrid{64, 64, 64, 0.36 / 64, Vec3(-0.18, -0.18, 0.0)};

HandFrame scripted_frame(double t) {
  HandFrame frame;
  make_scripted_hand({}, {})->sample(t, frame);
  to_device(default_tracker_pose(), frame);
  return frame;
}

HandFrame moved(HandFrame frame, const Vec3& by, const Vec3& velocity) {
  for (Hand& hand : frame.hands) {
    for (Vec3& p : hand.position) p += by;
    hand.velocity.fill(velocity);
  }
  return frame;
}

bool same(const HandRaster& a, const HandRaster& b) {
  return a.node_distance == b.node_distance && a.velocity[0] == b.velocity[0] &&
         a.velocity[1] == b.velocity[1] && a.velocity[2] == b.velocity[2] && a.swept == b.swept;
}

TEST(HandRaster, DistancesMatchTheShapeWithinTheBandAndAreFarBeyond) {
  WorkerPool pool(1);
  HandRasteriser rasteriser(kGrid);
  const HandFrame frame = scripted_frame(11.6);
  rasteriser.rasterise(frame, pool);
  const HandRaster& raster = rasteriser.raster();
  const HandShape shape(frame.hands[0]);
  const double band = 3.0 * kGrid.cell;
  int near = 0;
  for (int k = 0; k <= kGrid.nz; ++k) {
    for (int j = 0; j <= kGrid.ny; ++j) {
      for (int i = 0; i <= kGrid.nx; ++i) {
        const double expected = shape.distance(kGrid.node(i, j, k));
        const double found = static_cast<double>(raster.node_distance[kGrid.node_index(i, j, k)]);
        if (expected <= band - 1e-6) {
          ++near;
          ASSERT_NEAR(found, expected, 1e-7);
          const CellBox& box = raster.box;
          ASSERT_TRUE(i >= box.lower[0] && i <= box.upper[0] && j >= box.lower[1] &&
                      j <= box.upper[1] && k >= box.lower[2] && k <= box.upper[2]);
        } else {
          ASSERT_GE(found, band - 1e-6);
        }
      }
    }
  }
  EXPECT_GT(near, 5000);
}

TEST(HandRaster, VelocitiesMatchTheNearestSkin) {
  WorkerPool pool(1);
  HandRasteriser rasteriser(kGrid);
  HandFrame frame = scripted_frame(4.0);
  for (std::size_t j = 0; j < kJointCount; ++j)
    frame.hands[0].velocity[j] = 10.0 * frame.hands[0].position[j];
  rasteriser.rasterise(frame, pool);
  const HandShape shape(frame.hands[0]);
  double error = 0.0;
  int cells = 0, far_off = 0;
  for (int k = 0; k < kGrid.nz; ++k) {
    for (int j = 0; j < kGrid.ny; ++j) {
      for (int i = 0; i < kGrid.nx; ++i) {
        const SurfacePoint point = shape.query(kGrid.cell_centre(i, j, k));
        const std::size_t cell = kGrid.cell_index(i, j, k);
        const auto& moving = rasteriser.raster().velocity;
        const Vec3 v =
            Eigen::Vector3f(moving[0][cell], moving[1][cell], moving[2][cell]).cast<double>();
        if (std::abs(point.distance) < kGrid.cell) {
          ++cells;
          error += (v - point.velocity).norm();
          // near a crease the neighbouring body's skin point may be used, a few cells away at
          // most
          if ((v - point.velocity).norm() > 1e-5) ++far_off;
          EXPECT_LT((v - point.velocity).norm(), 10.0 * 0.03);
        } else if (point.distance > 6.0 * kGrid.cell) {
          EXPECT_EQ(v, Vec3::Zero());
        }
      }
    }
  }
  EXPECT_GT(cells, 1500);
  EXPECT_LT(far_off, cells / 5);
  EXPECT_LT(error / cells, 0.01);
}

TEST(HandRaster, NothingTunnelsAtOneMetrePerSecond) {
  // a hand moves edgewise by more than its thickness between frames: every cell on its way must
  // be solid now, or marked
  WorkerPool pool(2);
  const HandFrame start = scripted_frame(4.0);
  for (const Vec3& velocity : {Vec3(1, 0, 0), Vec3(0, 0.6, 0.8), Vec3(0, 0, -1)}) {
    HandRasteriser rasteriser(kGrid);
    const Vec3 step = 0.02 * velocity;
    rasteriser.rasterise(moved(start, Vec3::Zero(), velocity), pool);
    for (int n = 1; n <= 2; ++n) {
      const HandFrame now = moved(start, n * step, velocity);
      rasteriser.rasterise(now, pool);
      const HandShape shape(now.hands[0]);
      int crossed = 0;
      for (int sub = 0; sub < 24; ++sub) {
        const HandShape between(moved(start, (n - 1 + sub / 24.0) * step, velocity).hands[0]);
        const CellBox& box = rasteriser.raster().box;
        for (int k = box.lower[2]; k < box.upper[2]; ++k) {
          for (int j = box.lower[1]; j < box.upper[1]; ++j) {
            for (int i = box.lower[0]; i < box.upper[0]; ++i) {
              const Vec3 centre = kGrid.cell_centre(i, j, k);
              if ((centre.array() < between.lower().array()).any() ||
                  (centre.array() > between.upper().array()).any())
                continue;
              if (between.distance(centre) > 0.0 || shape.distance(centre) <= 0.0) continue;
              ++crossed;
              const std::size_t cell = kGrid.cell_index(i, j, k);
              ASSERT_EQ(rasteriser.raster().swept[cell], 1) << i << ' ' << j << ' ' << k;
              for (int a = 0; a < 3; ++a) {
                ASSERT_NEAR(static_cast<double>(rasteriser.raster().velocity[a][cell]), velocity[a],
                            1e-6);
              }
            }
          }
        }
      }
      EXPECT_GT(crossed, 1000);
    }
  }
}

TEST(HandRaster, SweptCellsAreFreeNowAndOnTheWay) {
  WorkerPool pool(1);
  HandRasteriser rasteriser(kGrid);
  const HandFrame start = scripted_frame(4.0),
                  end = moved(start, Vec3(0.0, 0.0, 0.03), Vec3(0, 0, 1.5));
  rasteriser.rasterise(start, pool);
  rasteriser.rasterise(end, pool);
  const HandShape now(end.hands[0]);
  int swept = 0;
  for (int k = 0; k < kGrid.nz; ++k) {
    for (int j = 0; j < kGrid.ny; ++j) {
      for (int i = 0; i < kGrid.nx; ++i) {
        if (rasteriser.raster().swept[kGrid.cell_index(i, j, k)] == 0) continue;
        ++swept;
        const Vec3 centre = kGrid.cell_centre(i, j, k);
        EXPECT_GT(now.distance(centre), 0.0);
        double nearest = 1.0;
        for (double u = 0.0; u <= 1.0; u += 0.05) {
          nearest =
              std::min(nearest, HandShape(moved(start, u * Vec3(0, 0, 0.03), Vec3::Zero()).hands[0])
                                    .distance(centre));
        }
        EXPECT_LT(nearest, 0.25 * kGrid.cell);
      }
    }
  }
  EXPECT_GT(swept, 500);
}

TEST(HandRaster, HandsAtRestOrNewSweepNothing) {
  WorkerPool pool(1);
  HandRasteriser rasteriser(kGrid);
  const auto swept = [&] {
    int count = 0;
    for (const std::uint8_t s : rasteriser.raster().swept) count += s;
    return count;
  };
  const HandFrame frame = scripted_frame(4.0);
  rasteriser.rasterise(frame, pool);
  EXPECT_EQ(swept(), 0);
  rasteriser.rasterise(frame, pool);
  EXPECT_EQ(swept(), 0);
  HandFrame other = moved(frame, Vec3(0.05, 0, 0), Vec3::Zero());
  other.hands[0].id += 1;
  rasteriser.rasterise(other, pool);
  EXPECT_EQ(swept(), 0);
}

TEST(HandRaster, TwoHandsGiveTheUnionOfBoth) {
  WorkerPool pool(1);
  HandFrame both = moved(scripted_frame(4.0), Vec3(-0.08, 0, 0), Vec3(0, 0, 1));
  HandFrame second = moved(scripted_frame(4.0), Vec3(0.07, 0, 0.02), Vec3(0, 0, -1));
  second.hands[0].id = 99;
  both.hands.push_back(second.hands[0]);
  HandRasteriser rasteriser(kGrid);
  rasteriser.rasterise(both, pool);
  const HandShape a(both.hands[0]), b(both.hands[1]);
  for (int k = 0; k <= kGrid.nz; k += 2) {
    for (int j = 0; j <= kGrid.ny; ++j) {
      for (int i = 0; i <= kGrid.nx; ++i) {
        const Vec3 p = kGrid.node(i, j, k);
        const double expected = std::min(a.distance(p), b.distance(p));
        if (expected > 2.9 * kGrid.cell) continue;
        ASSERT_NEAR(
            static_cast<double>(rasteriser.raster().node_distance[kGrid.node_index(i, j, k)]),
            expected, 1e-7);
      }
    }
  }
}

TEST(HandRaster, EarlierFramesHaveNoEffect) {
  WorkerPool pool(1);
  HandRasteriser used(kGrid), fresh(kGrid);
  for (const double t : {4.0, 6.9, 11.5, 15.3}) used.rasterise(scripted_frame(t), pool);
  used.rasterise(HandFrame(), pool);
  EXPECT_TRUE(used.raster().box.empty());
  EXPECT_TRUE(same(used.raster(), fresh.raster()));
  used.rasterise(scripted_frame(7.0), pool);
  fresh.rasterise(scripted_frame(7.0), pool);
  EXPECT_TRUE(same(used.raster(), fresh.raster()));
}

TEST(HandRaster, DoesNotDependOnTheNumberOfThreads) {
  WorkerPool one(1), three(3);
  HandRasteriser a(kGrid), b(kGrid);
  for (double t = 6.0; t < 8.0; t += 0.1) {
    a.rasterise(scripted_frame(t), one);
    b.rasterise(scripted_frame(t), three);
    ASSERT_TRUE(same(a.raster(), b.raster())) << t;
  }
}

TEST(HandRaster, AcceptsHandsAnywhereAndIgnoresNonFiniteOnes) {
  WorkerPool pool(1);
  HandRasteriser rasteriser(kGrid);
  const HandFrame frame = scripted_frame(4.0);
  for (const Vec3& by :
       {Vec3(0.2, 0, 0), Vec3(0, 0, -0.25), Vec3(1e6, 0, 0), Vec3(0, -1e12, 1e12)}) {
    rasteriser.rasterise(moved(frame, by, Vec3::Zero()), pool);
    const CellBox& box = rasteriser.raster().box;
    for (int a = 0; a < 3; ++a) {
      EXPECT_GE(box.lower[a], 0);
      EXPECT_LE(box.upper[a], 64);
    }
  }
  EXPECT_TRUE(rasteriser.raster().box.empty());
  HandFrame broken = frame;
  broken.hands[0].position[kIndexTip].x() = std::numeric_limits<double>::quiet_NaN();
  rasteriser.rasterise(broken, pool);
  EXPECT_TRUE(rasteriser.raster().box.empty());
}

TEST(HandRaster, DoesNotAllocate) {
  WorkerPool pool(1);
  HandRasteriser rasteriser(kGrid);
  const HandFrame a = scripted_frame(4.0), b = moved(a, Vec3(0.05, 0.02, 0), Vec3(1, 0, 0));
  test::HeapGuard guard;
  for (int i = 0; i < 4; ++i) rasteriser.rasterise(i % 2 == 0 ? a : b, pool);
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(HandRaster, RejectsInvalidGridsAndBands) {
  EXPECT_THROW(HandRasteriser(kGrid, 1.0), std::invalid_argument);
  EXPECT_THROW(HandRasteriser(kGrid, 17.0), std::invalid_argument);
  EXPECT_THROW(HandRasteriser(GridShape(), 3.0), std::invalid_argument);
}

}  // namespace
}  // namespace prostm
