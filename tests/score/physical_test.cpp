#include "prostm/score/physical.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "prostm/core/units.hpp"
#include "prostm/emit/compensation.hpp"
#include "prostm/plan/lifted_plan.hpp"

namespace prostm {
namespace {

/// Returns 100 × 100 mm of skin in 5 mm cells, with height h(x, y) [m].
template <class Height>
TargetField raster(Height&& height) {
  TargetField field;
  field.resize(21, 21);
  field.cell = 5e-3;
  field.origin = Vec2(-0.05, -0.05);
  for (int row = 0; row < field.rows; ++row) {
    for (int col = 0; col < field.cols; ++col) {
      const Vec2 x = field.position(row, col);
      field.skin[field.index(row, col)] = 1;
      field.height[field.index(row, col)] = height(x.x(), x.y());
    }
  }
  return field;
}

/// Returns two square paths, with pressures from 0.5 to 1 times `pressure`.
LiftedPlan two_squares(const TargetField& field, double pressure) {
  Plan plan;
  for (const double side : {-1.0, 1.0}) {
    plan.paths.emplace_back();
    FocalPath& path = plan.paths.back();
    for (int i = 0; i < 16; ++i) {
      const double a = 2.0 * kPi * i / 16.0;
      path.points.emplace_back(0.022 * side + 0.012 * std::cos(a), 0.016 * std::sin(a));
      path.pressure.push_back(pressure * (0.75 + 0.25 * std::sin(a)));
    }
    path.length = closed_length(path);
    path.speed = 7.0;
  }
  TargetFrame frame;
  frame.patches.push_back(field);
  LiftedPlan lifted;
  lift(plan, frame, lifted);
  return lifted;
}

LoopSamples loop_of(const LiftedPlan& plan) {
  EmitSettings settings;
  settings.full_scale_pressure = 1.0;
  settings.silent_below = 0.0;
  return loop_samples(plan, settings, 40e3);
}

bool go_on(int, int) {
  return true;
}

LoopDriveResult drives_of(const LoopSamples& loop, const LoopDriveSettings& settings) {
  LoopDriveResult out;
  EXPECT_TRUE(loop_drives(usx_array(), Medium(), loop, settings, go_on, out));
  return out;
}

TEST(SkinSurface, NormalsFollowTheSlope) {
  const double tilt = 0.5;
  const SkinSurface skin =
      skin_surface(raster([&](double x, double) { return std::tan(tilt) * x; }));
  ASSERT_EQ(skin.cell.size(), 441u);
  const Vec3 expected(std::sin(tilt), 0.0, -std::cos(tilt));
  for (const Vec3& n : skin.points.normal) EXPECT_LT((n - expected).norm(), 1e-6);
  EXPECT_NEAR(skin.points.p_D[0].z(), 0.2 - 0.05 * std::tan(tilt), 1e-12);
}

TEST(SkinSurface, ASingleCellOrRowFacesTheArray) {
  TargetField field = raster([](double, double y) { return y; });
  std::fill(field.skin.begin(), field.skin.end(), std::uint8_t{0});
  for (int col = 3; col < 9; ++col) field.skin[field.index(10, col)] = 1;
  field.skin[field.index(0, 0)] = 1;
  for (const Vec3& n : skin_surface(field).points.normal) {
    EXPECT_LT((n + Vec3::UnitZ()).norm(), 1e-6);
  }
}

/// Returns 155 × 155 mm of tilted skin in square cells.
TargetField wide_raster(int cells) {
  TargetField field;
  field.resize(cells, cells);
  field.cell = 0.155 / cells;
  field.origin = Vec2::Constant(0.5 * field.cell - 0.0775);
  for (std::size_t c = 0; c < field.size(); ++c) {
    field.skin[c] = 1;
    field.height[c] = 0.2 * field.position(c).x();
  }
  return field;
}

// With cells wider than a lobe the largest values lie between the cells' centres.
TEST(Physical, LargestValuesDoNotDependOnTheCells) {
  const PackedArray packed(usx_array(), Medium());
  WorkerPool pool(2);
  const TargetField coarse = wide_raster(31), fine = wide_raster(155);
  const LoopSamples loop = loop_of(two_squares(coarse, 1.0));
  const LoopDriveResult drives = drives_of(loop, {});
  const PhysicalField wide = physical_field(packed, Medium(), coarse, loop, drives, 0, pool),
                      narrow = physical_field(packed, Medium(), fine, loop, drives, 0, pool);
  const auto at_cells = [](const PhysicalField& field) {
    return *std::max_element(field.envelope.begin(), field.envelope.end());
  };
  std::printf(
      "side lobe %.4f and %.4f, largest %.2f and %.2f Pa (in the middle of cells %.2f and "
      "%.2f Pa) on cells of 5 and 1 mm\n",
      wide.side_lobe, narrow.side_lobe, wide.largest, narrow.largest, at_cells(wide),
      at_cells(narrow));
  EXPECT_NEAR(wide.largest, narrow.largest, 0.01 * narrow.largest);
  EXPECT_NEAR(wide.largest_mean, narrow.largest_mean, 0.01 * narrow.largest_mean);
  EXPECT_NEAR(wide.side_lobe, narrow.side_lobe, 0.04 * narrow.side_lobe);
}

// Plan → emission → drives → transducers → field, at a full scale that the array can reach.
TEST(Physical, HalfTheTargetGivesHalfTheRadiationPressure) {
  const TargetField field = raster([](double x, double) { return 0.2 * x; });
  const PackedArray packed(usx_array(), Medium());
  WorkerPool pool(2);
  LoopDriveSettings settings;
  settings.full_scale_pa = 150.0;
  std::vector<PhysicalField> fields;
  for (const double pressure : {1.0, 0.5}) {
    const LoopSamples loop = loop_of(two_squares(field, pressure));
    const LoopDriveResult drives = drives_of(loop, settings);
    EXPECT_EQ(drives.short_samples, 0);
    fields.push_back(physical_field(packed, Medium(), field, loop, drives, 0, pool));
  }
  for (std::size_t c = 0; c < field.size(); ++c) {
    EXPECT_NEAR(fields[1].mean[c], 0.5 * fields[0].mean[c], 2e-4 * fields[0].largest_mean);
    EXPECT_NEAR(fields[1].envelope[c], 0.5 * fields[0].envelope[c], 1e-3 * fields[0].largest);
  }
}

TEST(LoopDrives, TheCommonScaleHoldsInEverySample) {
  const LoopSamples loop = loop_of(two_squares(raster([](double, double) { return 0.0; }), 1.0));
  LoopDriveSettings settings;
  settings.transducer.memoryless = true;
  settings.focus.method = FocusMethod::GsPat;
  EXPECT_LT(drives_of(loop, settings).full_share, 0.1);  // the drives of a sample differ
  settings.focus.method = FocusMethod::Weighted;
  const LoopDriveResult drives = drives_of(loop, settings);
  EXPECT_EQ(drives.short_samples, 0);
  EXPECT_NEAR(drives.largest_drive, 1.0, 1e-9);
  EXPECT_GT(drives.full_scale_pa, 100.0);
  EXPECT_LE(drives.mean_power, 256.0);
  EXPECT_GE(drives.full_share, 1.0 / loop.samples);  // all drives of a sample are equal
  const PackedArray packed(usx_array(), Medium());
  const FocusAccuracy focus = focus_accuracy(packed, loop, drives, TargetField::default_plane());
  EXPECT_GT(focus.looked_at, 100);
  EXPECT_NEAR(focus.mean_level, 1.0, 0.05);
  EXPECT_LT(focus.worst_offset, 2e-3);
  // at four times the full scale every sample falls short of it
  settings.full_scale_pa = 40.0 * drives.full_scale_pa;
  EXPECT_EQ(drives_of(loop, settings).short_samples, loop.samples);
}

// Transducers lag: a focal point at 7 m/s is behind by about v τ = 1.6 mm, and weaker.
TEST(LoopDrives, TransducersLagBehind) {
  const LoopSamples loop = loop_of(two_squares(raster([](double, double) { return 0.0; }), 1.0));
  const PackedArray packed(usx_array(), Medium());
  const LoopDriveResult drives = drives_of(loop, {});
  const FocusAccuracy focus = focus_accuracy(packed, loop, drives, TargetField::default_plane());
  EXPECT_GT(focus.mean_offset, 1.0e-3);
  EXPECT_LT(focus.mean_offset, 2.0e-3);
  EXPECT_LT(focus.mean_level, 0.97);
}

TEST(LoopDrives, StopsOnRequestAndRejectsSilence) {
  const TargetField field = raster([](double, double) { return 0.0; });
  LoopDriveResult out;
  EXPECT_FALSE(loop_drives(
      usx_array(), Medium(), loop_of(two_squares(field, 1.0)), {},
      [](int done, int) { return done < 5; }, out));
  EXPECT_THROW(loop_drives(usx_array(), Medium(), loop_of(two_squares(field, 0.0)), {}, go_on, out),
               std::invalid_argument);
}

TEST(LoopDrives, OneOfTwoCoincidingFocalPointsIsDropped) {
  LiftedPlan plan = two_squares(raster([](double, double) { return 0.0; }), 1.0);
  plan.paths[1] = plan.paths[0];
  EXPECT_EQ(drives_of(loop_of(plan), {}).merged, loop_of(plan).samples);
}

// With equal requested pressure tilted skin gets less; with (E8) it gets the same.
TEST(Physical, TiltedSkinGetsThePressureOfLevelSkinIfCompensated) {
  const PackedArray packed(usx_array(), Medium());
  WorkerPool pool(2);
  LoopDriveSettings settings;
  settings.full_scale_pa = 100.0;
  settings.transducer.memoryless = true;
  const auto largest_of = [&](double tilt, double bound) {
    TargetFrame frame;
    frame.patches.push_back(raster([&](double x, double) { return std::tan(tilt) * x; }));
    const TargetField& field = frame.patches[0];
    LiftedPlan plan = two_squares(field, 0.4);
    plan.paths.pop_back();  // two focal points interfere by more than the error of (E8)
    compensate_tilt(plan, frame, bound);
    const LoopSamples loop = loop_of(plan);
    const PhysicalField out =
        physical_field(packed, Medium(), field, loop, drives_of(loop, settings), 0, pool);
    return out.largest;
  };
  const double level = largest_of(0.0, 1.0);
  EXPECT_LT(largest_of(0.6, 1.0), 0.8 * level);
  EXPECT_NEAR(largest_of(0.6, 2.0), level, 0.07 * level);
}

TEST(Physical, ScoresItsOwnFieldAsPerfectInAnyUnit) {
  TargetField target = raster([](double, double) { return 0.0; });
  for (std::size_t c = 0; c < target.size(); ++c) {
    target.pressure[c] = 1.0 + std::sin(0.3 * static_cast<double>(c));
  }
  std::vector<double> field(target.pressure);
  for (double& p : field) p *= 37.0;
  const Metrics m = score_physical(target, field, 0.7);
  EXPECT_NEAR(m.rmse, 0.0, 1e-12);
  EXPECT_NEAR(m.skill_0, 1.0, 1e-12);
  EXPECT_EQ(m.coverage, 0.7);
  EXPECT_EQ(score_physical(target, std::vector<double>(target.size(), 0.0), 0.7).rmse, 0.0);
}

}  // namespace
}  // namespace prostm
