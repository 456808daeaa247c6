#include "prostm/emit/played.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "prostm/core/units.hpp"
#include "prostm/emit/compensation.hpp"
#include "prostm/emit/detail/path_emitter.hpp"

namespace prostm {
namespace {

constexpr double kRate = 40e3;  // [Hz]

EmitSettings settings(double full_scale = 1.0) {
  EmitSettings s;
  s.full_scale_pressure = full_scale;
  return s;
}

TargetFrame flat_frame(int cells = 60) {
  TargetFrame frame;
  frame.patches.emplace_back();
  TargetField& field = frame.patches[0];
  field.resize(cells, cells);
  field.cell = 5e-3;
  field.origin = Vec2::Constant(-0.5 * field.cell * (cells - 1));
  field.skin.assign(field.size(), 1);
  return frame;
}

/// Returns a regular polygon whose pressure drops to `low` midway between samples of 1.
FocalPath spiky(const Vec2& centre, double length, double low) {
  constexpr int kPoints = 28;
  FocalPath path;
  const double radius = length / (2.0 * kPoints * std::sin(kPi / kPoints));
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 2.0 * kPi * i / kPoints;
    path.points.push_back(centre + radius * Vec2(std::cos(angle), std::sin(angle)));
    path.pressure.push_back(i % 4 == 0 ? 1.0 : low);
  }
  path.length = closed_length(path);
  path.speed = 7.0;
  path.period = path.length / path.speed;
  return path;
}

/// Returns the pressures of the first path as emitted by PathEmitter in `laps` laps, from the
/// second lap on.
std::vector<double> emitted(const Plan& plan, const TargetFrame& frame, EmitSettings s,
                            std::size_t lap, std::size_t laps) {
  s.foci = static_cast<int>(plan.paths.size());
  s.stall_time = 10.0;
  PathEmitter emitter(s, kRate);
  lift(plan, frame, emitter.draft());
  compensate_tilt(emitter.draft(), frame, s.tilt_bound);
  emitter.submit();
  const auto foci = static_cast<std::size_t>(s.foci);
  std::vector<FocusSample> block((1 + (1 + laps) * lap) * foci);
  emitter.fill(0, block);
  std::vector<double> pressure;
  for (std::size_t k = 0; k < laps * lap; ++k) {
    const double intensity = static_cast<double>(block[(1 + lap + k) * foci].intensity);
    pressure.push_back(s.full_scale_pressure * intensity * intensity);
  }
  return pressure;
}

/// Returns the played pressure of the first path at sample k of a lap, for a polygon with equal
/// edges.
double played_at(const SegmentPressures& played, const Plan& plan, std::size_t k, std::size_t lap) {
  const std::size_t points = plan.paths[0].points.size();
  const double place =
      static_cast<double>(k % lap) / static_cast<double>(lap) * static_cast<double>(points);
  const auto segment = std::min(static_cast<std::size_t>(place), points - 1);
  return played.at(segment, place - static_cast<double>(segment));
}

TEST(PlayedPressures, MatchTheEmittersSecondLap) {
  const TargetFrame frame = flat_frame();
  Plan plan;
  plan.paths.push_back(spiky(Vec2::Zero(), 0.140, 0.0));
  for (const double full_scale : {1.0, 3.0, 0.6}) {
    const EmitSettings s = settings(full_scale);
    const SegmentPressures played = played_pressures(plan, frame, s, kRate);
    ASSERT_EQ(played.end.size(), 28u);
    const std::vector<double> theirs = emitted(plan, frame, s, 800, 1);
    double lowest = 1.0, largest_error = 0.0;
    for (std::size_t k = 0; k < theirs.size(); ++k) {
      // the second lap's first sample follows the path's first point
      const double ours = played_at(played, plan, k + 1, 800);
      largest_error = std::max(largest_error, std::abs(ours - theirs[k]));
      lowest = std::min(lowest, ours);
    }
    // within a segment the pressures lie between the samples, not on them
    EXPECT_LT(largest_error, 0.03 * full_scale);
    // a segment has 29 samples; an intensity takes 40 from full scale to zero
    EXPECT_GT(played.at(1, 0.0) - plan.paths[0].pressure[1], 0.02);
  }
}

TEST(PlayedPressures, EqualThePlannedOnesWhereTheyChangeSlowly) {
  const TargetFrame frame = flat_frame();
  Plan plan;
  plan.paths.push_back(spiky(Vec2(-0.05, 0.0), 0.140, 0.9));
  plan.paths.push_back(spiky(Vec2(0.05, 0.0), 0.098, 0.9));
  const SegmentPressures played = played_pressures(plan, frame, settings(), kRate);
  ASSERT_EQ(played.end.size(), 56u);
  for (std::size_t segment = 0; segment < 56; ++segment) {
    const FocalPath& path = plan.paths[segment / 28];
    for (const double along : {0.0, 0.3, 1.0}) {
      const double a = path.pressure[segment % 28], b = path.pressure[(segment + 1) % 28];
      EXPECT_NEAR(played.at(segment, along), a + along * (b - a), 0.003);
    }
  }
}

TEST(PlayedPressures, FollowThePowerLimit) {
  const TargetFrame frame = flat_frame();
  Plan plan;
  for (int k = 0; k < 4; ++k) {
    plan.paths.push_back(spiky(Vec2(0.06 * k - 0.09, 0.0), 0.140, 1.0));
  }
  EmitSettings s = settings();
  s.power_limit = 1.0;
  const SegmentPressures played = played_pressures(plan, frame, s, kRate);
  for (std::size_t segment = 0; segment < 4 * 28; ++segment) {
    EXPECT_NEAR(played.at(segment, 0.5), 0.25, 1e-6);
  }
  // if laps differ in length, the mean over laps
  plan.paths.clear();
  plan.paths.push_back(spiky(Vec2(-0.05, 0.0), 0.140, 0.2));
  plan.paths.push_back(spiky(Vec2(0.05, 0.0), 0.099, 0.2));
  s.power_limit = 1.2;
  const SegmentPressures limited = played_pressures(plan, frame, s, kRate);
  const std::vector<double> theirs = emitted(plan, frame, s, 800, 30);
  double ours = 0.0, all = 0.0;
  for (std::size_t k = 0; k < 800; ++k) ours += played_at(limited, plan, k, 800) / 800.0;
  for (const double p : theirs) all += p / static_cast<double>(theirs.size());
  EXPECT_NEAR(ours, all, 0.01);
}

TEST(PlayedPressures, InStepMatchTheEmittersSecondLoop) {
  const TargetFrame frame = flat_frame();
  Plan plan;
  plan.loop = 20e-3;
  const int laps[] = {3, 2};  // 800 is not a multiple of three laps
  for (int k = 0; k < 2; ++k) {
    plan.paths.push_back(spiky(Vec2(0.06 * k, 0.0), 0.045, 0.3));
    FocalPath& path = plan.paths.back();
    path.speed = path.length * laps[k] / plan.loop;
    path.period = plan.loop / laps[k];
  }
  for (const double power_limit : {4.0, 0.9}) {
    EmitSettings s = settings();
    s.power_limit = power_limit;
    const SegmentPressures played = played_pressures(plan, frame, s, kRate);
    const std::vector<double> theirs = emitted(plan, frame, s, 800, 1);
    double worst = 0.0;
    std::vector<double> at_place(800);
    for (std::size_t k = 0; k < 800; ++k) at_place[3 * (k + 1) % 800] = theirs[k];
    for (std::size_t i = 0; i < 800; ++i) {
      // the power limit makes laps differ: the mean of the three that pass there
      const double mean = (at_place[(i + 799) % 800] + at_place[i] + at_place[(i + 1) % 800]) / 3.0;
      worst = std::max(worst, std::abs(played_at(played, plan, i, 800) - mean));
    }
    EXPECT_LT(worst, 0.03) << power_limit;
  }
  plan.loop = -1.0;
  EXPECT_THROW(played_pressures(plan, frame, settings(), kRate), std::invalid_argument);
}

TEST(PlayedPressures, OnTiltedSkinLackWhatExceedsFullScale) {
  TargetFrame frame = flat_frame();
  TargetField& field = frame.patches[0];
  for (int row = 0; row < field.rows; ++row) {
    for (int col = 0; col < field.cols; ++col) {
      field.height[field.index(row, col)] = field.position(row, col).x();  // 45°
    }
  }
  Plan plan;
  plan.paths.push_back(spiky(Vec2::Zero(), 0.140, 1.0));
  EmitSettings s = settings(3.0);
  s.tilt_bound = 4.0;
  const auto range = [&] {
    const SegmentPressures played = played_pressures(plan, frame, s, kRate);
    const auto [low, high] = std::minmax_element(played.pressure.begin(), played.pressure.end());
    return std::pair(*low, *high);
  };
  // headroom for the factor of about two: pressures as planned
  EXPECT_NEAR(range().first, 1.0, 0.02);
  EXPECT_NEAR(range().second, 1.0, 0.02);
  // no headroom: about half remains
  s.full_scale_pressure = 1.0;
  EXPECT_NEAR(range().second, 0.5, 0.2);
  // not compensated: pressures as planned
  s.tilt_bound = 1.0;
  EXPECT_NEAR(range().first, 1.0, 1e-9);
}

TEST(PlayedPressures, OfFociArePeakPressures) {
  const TargetFrame frame = flat_frame();
  Plan plan;
  plan.foci.push_back({0, Vec2(0.01, 0.0), 0.3});
  plan.foci.push_back({0, Vec2(-0.03, 0.0), 2.0});
  const SegmentPressures played = played_pressures(plan, frame, settings(), kRate);
  ASSERT_EQ(played.end.size(), 2u);
  EXPECT_NEAR(played.at(0, 0.0), 0.3, 1e-6);
  EXPECT_NEAR(played.at(1, 0.5), 1.0, 1e-6);  // full scale
}

TEST(PlayedPressures, AcceptUnusualPlans) {
  const TargetFrame frame = flat_frame();
  Plan plan;
  EXPECT_TRUE(played_pressures(plan, frame, settings(), kRate).end.empty());
  FocalPath path;  // a point at rest, and a path that hardly moves
  for (int i = 0; i < 3; ++i) {
    path.points.push_back(Vec2(0.01, 0.02));
    path.pressure.push_back(0.5);
  }
  path.speed = 7.0;
  plan.paths.push_back(path);
  path = spiky(Vec2::Zero(), 0.140, 0.5);
  path.speed = 1e-3;
  plan.paths.push_back(path);
  const SegmentPressures played = played_pressures(plan, frame, settings(), kRate);
  ASSERT_EQ(played.end.size(), 31u);
  EXPECT_NEAR(played.at(1, 0.7), 0.5, 1e-12);
  EXPECT_NEAR(played.at(3, 0.0), 1.0, 1e-3);
  EXPECT_THROW(played_pressures(plan, frame, settings(0.0), kRate), std::invalid_argument);
}

}  // namespace
}  // namespace prostm
