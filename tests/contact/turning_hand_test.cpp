// Targets of turning hands: neither planes nor pressures may jump.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "prostm/acoustics/field/focus_width.hpp"
#include "prostm/contact/skin_contact.hpp"
#include "prostm/core/units.hpp"
#include "prostm/fluid/fluid_pressure.hpp"
#include "prostm/io/hand/hand_file.hpp"
#include "prostm/plan/lifted_plan.hpp"
#include "prostm/plan/planner.hpp"
#include "prostm/score/physical.hpp"
#include "prostm/track/hand_source.hpp"
#include "support/shared.hpp"

namespace prostm {
namespace {

constexpr double kDegree = kPi / 180.0;
const GridShape kGrid{64, 64, 64, 0.36 / 64, Vec3(-0.18, -0.18, 0.0)};

double angle(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Hands in air.
struct Air {
  Air() : pressure(kGrid.cell_count(), 0.0F), free(kGrid.cell_count(), 1) {}

  ContactStats extract(const HandFrame& frame) {
    rasteriser.rasterise(frame, pool);
    air.take(pressure, free, 0.04);
    return contact.extract(air, rasteriser.raster(), frame, target);
  }

  /// Presses on `hand` like jets along z, by Newton's law: ½ρv² cos² of the angle between jet and
  /// skin.
  /// @param jets centres of jets of 18 mm; empty: one jet as wide as the box.
  ContactStats blow(const Hand& hand, const std::vector<Vec2>& jets) {
    HandFrame frame;
    frame.hands.push_back(hand);
    frame.hands[0].id = ++poses;  // a new hand, without a swept volume
    rasteriser.rasterise(frame, pool);
    const CellBox& box = rasteriser.raster().box;
    for (int k = box.lower[2]; k < box.upper[2]; ++k) {
      for (int j = box.lower[1]; j < box.upper[1]; ++j) {
        for (int i = box.lower[0]; i < box.upper[0]; ++i) press(i, j, k, jets);
      }
    }
    return extract(frame);
  }

  void press(int i, int j, int k, const std::vector<Vec2>& jets) {
    constexpr double kStagnation = 0.15;  // [Pa], of 0.5 m/s
    double distance = 0.0;
    Vec3 gradient = Vec3::Zero();
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Array3i up(corner & 1, corner >> 1 & 1, corner >> 2);
      const auto d = static_cast<double>(
          rasteriser.raster().node_distance[kGrid.node_index(i + up.x(), j + up.y(), k + up.z())]);
      distance += d / 8.0;
      gradient += d * (2.0 * up.cast<double>() - 1.0).matrix();
    }
    const double cosine = std::max(0.0, -gradient.normalized().z());
    const Vec2 x = kGrid.cell_centre(i, j, k).head<2>();
    double share = jets.empty() ? 1.0 : 0.0;
    for (const Vec2& jet : jets) share += std::exp(-2.0 * std::pow((x - jet).norm() / 0.018, 4));
    const std::size_t c = kGrid.cell_index(i, j, k);
    free[c] = distance > 0.0 ? 1 : 0;
    pressure[c] = static_cast<float>(kStagnation * cosine * cosine * share);
  }

  int poses = 0;
  WorkerPool pool{1};
  HandRasteriser rasteriser{kGrid};
  FluidPressure air{{}, kGrid};
  SkinContact contact{{}, kGrid};
  std::vector<float> pressure;
  std::vector<std::uint8_t> free;
  TargetFrame target;
};

Hand flat_hand() {
  ScriptedHandSettings settings;
  settings.still = true;
  HandFrame frame;
  make_scripted_hand(settings, {})->sample(0.0, frame);
  to_device(default_tracker_pose(), frame);
  return frame.hands.at(0);
}

/// Returns the hand rotated rigidly about an axis through its middle, which is placed 200 mm above
/// the array.
Hand turned(Hand hand, double by, const Vec3& axis) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : hand.position) middle += p / kJointCount;
  const Eigen::AngleAxisd turn(by, axis.normalized());
  for (Vec3& p : hand.position) p = turn * (p - middle) + Vec3(0, 0, 0.2);
  for (Quat& q : hand.orientation) q = Quat(turn) * q;
  return hand;
}

double force_of(const TargetField& patch) {
  double force = 0.0;
  for (const double p : patch.pressure) force += p * patch.cell * patch.cell;
  return force;
}

/// Target of a hand at an angle.
struct Felt {
  Vec3 normal = Vec3::Zero();
  double force = 0.0, area = 0.0;
};

TEST(TurningHand, PlaneForceAndAreaChangeLittlePerDegree) {
  Air air;
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0),
                           Vec3(1, -2, 0), Vec3(-1, 2, 0), Vec3(2, 1, 0), Vec3(-1, 1, 0)}) {
    constexpr double kStep = 0.5;  // [°]
    std::vector<Felt> felt;
    double force = 0.0, area = 0.0;
    for (double at = 0.0; at <= 90.0; at += kStep) {
      Felt now;
      now.area = air.blow(turned(flat_hand(), at * kDegree, axis), {}).skin_area;
      for (const TargetField& patch : air.target.patches) {
        now.normal = patch.X_DP.linear().col(2);
        now.force = force_of(patch);
      }
      felt.push_back(now);
      force = std::max(force, now.force);
      area = std::max(area, now.area);
    }
    // changes per degree
    double turn = 0.0, force_change = 0.0, area_change = 0.0;
    for (std::size_t n = 2; n < felt.size(); ++n) {
      const Felt &last = felt[n - 1], &now = felt[n];
      if (last.area > 0.0 && now.area > 0.0) {
        turn = std::max(turn, angle(last.normal, now.normal) / kDegree);
      }
      force_change = std::max(force_change, std::abs(now.force - felt[n - 2].force) / force);
      area_change = std::max(area_change, std::abs(now.area - felt[n - 2].area) / area);
    }
    std::printf(
        "about (%g, %g): the plane turns by at most %.2f° in 0.5°; the force changes by at "
        "most %.1f %% of its largest a degree, the area by %.1f %%\n",
        axis.x(), axis.y(), turn, 100.0 * force_change, 100.0 * area_change);
    EXPECT_LT(turn, 1.5 * kStep + 1.0);
    EXPECT_LT(force_change, 0.05);
    EXPECT_LT(area_change, 0.05);
  }
}

/// Returns the largest angle by which a bone has rotated.
double bones_turn(const Hand& before, const Hand& now) {
  double largest = 0.0;
  for (std::size_t j = 1; j < kJointCount; ++j) {
    const bool metacarpal = j == kThumbMetacarpal || j == kIndexMetacarpal ||
                            j == kMiddleMetacarpal || j == kRingMetacarpal ||
                            j == kLittleMetacarpal;
    const std::size_t parent = metacarpal ? std::size_t{kWrist} : j - 1;
    largest = std::max(largest, angle(before.position[j] - before.position[parent],
                                      now.position[j] - now.position[parent]));
  }
  return largest;
}

/// Returns the hand that a patch belongs to: the one nearest to a cell of the patch.
const Hand& hand_of(const TargetField& patch, const HandFrame& frame) {
  std::size_t cell = 0;
  while (patch.skin[cell] == 0) ++cell;
  const Vec2 x = patch.position(cell);
  const Vec3 p = patch.X_DP * Vec3(x.x(), x.y(), patch.height[cell]);
  const auto distance = [&](const Hand& hand) { return HandShape(hand).distance(p); };
  return *std::min_element(frame.hands.begin(), frame.hands.end(),
                           [&](const Hand& a, const Hand& b) { return distance(a) < distance(b); });
}

TEST(TurningHand, PlanesOfRecordedHandsDoNotJump) {
  PROSTM_NEEDS_SHARED("data/hands");
  constexpr double kUpdate = 0.04;
  struct Known {
    Hand hand;
    Vec3 normal;
  };
  Air air;
  for (const std::string name : {"HandSplay-110fps", "finger-tap-54fps", "flapping", "pinch-57fps",
                                 "rollAndPitchWithEntry"}) {
    const auto source = make_recorded_hand(
        read_hand_recording(test::shared_file("data/hands/" + name + ".hands.jsonl")), {}, false,
        kUpdate);
    std::vector<Known> before;
    int compared = 0;
    double turn = 0.0;
    for (int n = 0; n * kUpdate < source->recording_length(); ++n) {
      HandFrame frame;
      source->sample(n * kUpdate, frame);
      to_device(default_tracker_pose(), frame);
      air.extract(frame);
      std::vector<Known> now;
      for (const TargetField& patch : air.target.patches) {
        now.push_back({hand_of(patch, frame), patch.X_DP.linear().col(2)});
        const Hand& hand = now.back().hand;
        for (const Known& last : before) {
          if (last.hand.id != hand.id || last.hand.side != hand.side) continue;
          if (bones_turn(last.hand, hand) >= 3.0 * kDegree) continue;
          ++compared;
          turn = std::max(turn, angle(last.normal, now.back().normal));
        }
      }
      before = std::move(now);
    }
    std::printf(
        "%s: the plane turns by at most %.1f° in %d updates of bones that turn by less "
        "than 3°\n",
        name.c_str(), turn / kDegree, compared);
    EXPECT_LT(turn, 10.0 * kDegree) << name;
    EXPECT_GT(compared, 2) << name;
  }
}

struct Skill {
  double planned = 0.0, played = 0.0;
};

/// Returns S_0 of a plan by its own model, with the array's focal width as in a run, and S_0 of the
/// envelope that the array produces on the skin.
Skill skill_of(const TargetFrame& target) {
  constexpr double kRate = 40e3;  // [Hz]
  const TargetField& patch = target.patches.at(0);
  const Medium air;
  const PackedArray packed(usx_array(), air);
  const Eigen::Matrix3d axes = patch.X_DP.linear();
  PlanSettings settings;
  settings.sigma = focus_width(packed, air, Vec3(0, 0, 0.2), -axes.col(2), axes.col(0)).sigma();
  Planner planner(settings, patch.size());
  Plan plan;
  PlanStats stats;
  EXPECT_EQ(planner.plan(patch, plan, stats), PlanStatus::Planned);
  LiftedPlan lifted;
  lift(plan, target, lifted);
  EmitSettings emit;
  for (const LiftedPath& path : lifted.paths) {
    for (const double p : path.pressure) {
      emit.full_scale_pressure = std::max(emit.full_scale_pressure, p);
    }
  }
  const LoopSamples loop = loop_samples(lifted, emit, kRate);
  LoopDriveResult drives;
  EXPECT_TRUE(loop_drives(
      usx_array(), air, loop, {}, [](int, int) { return true; }, drives));
  WorkerPool pool(1);
  const PhysicalField field = physical_field(packed, air, patch, loop, drives, 0, pool);
  return {score_plan(patch, plan, 0, settings.sigma, settings.gain_law()).skill_0,
          score_physical(patch, field.envelope, 0.0).skill_0};
}

TEST(TurningHand, PlannedPressureIsPlayedUpToTheLimit) {
  Air air;
  const std::vector<Vec2> four = {
      {0.024, 0.024}, {-0.024, 0.024}, {0.024, -0.024}, {-0.024, -0.024}};
  const std::vector<Vec2> wide = {
      {0, 0}, {0.012, 0.012}, {-0.012, 0.012}, {0.012, -0.012}, {-0.012, -0.012}};
  for (const double at : {30.0, 50.0}) {
    for (const std::vector<Vec2>& jets : {four, wide}) {
      air.blow(turned(flat_hand(), at * kDegree, -Vec3::UnitX()), jets);
      const Skill skill = skill_of(air.target);
      std::printf("%zu jets at %.0f°: S_0 %.3f planned, %.3f played\n", jets.size(), at,
                  skill.planned, skill.played);
      EXPECT_NEAR(skill.planned, skill.played, 0.15) << jets.size() << " jets at " << at;
    }
  }
}

}  // namespace
}  // namespace prostm
