#pragma once
/// Motion of one focal point: along a path in whole laps of samples, and from one path to the next.

#include <cstdint>

#include "prostm/plan/lifted_plan.hpp"

namespace prostm {

/// A focal point on a closed path. Sample k of a lap lies at arc length s₀ ± L k/n, where n = ⌈L /
/// step⌉ samples make a lap, (E2); so positions depend on integer counts and never drift.
///
/// A new path is joined at the place nearest to the focal point, in the direction that turns less.
/// The remaining offset between the two is carried along and shrinks in each sample by as much as
/// the largest step allows, (E3).
class FocusMotion {
 public:
  /// @param sample_rate [Hz]; @param max_step largest step between samples [m].
  void configure(double sample_rate, double max_step);

  /// True when the offset to `place` is gone within kMaxTransit wherever it points, and is at most
  /// kMaxOffset.
  bool reaches(const LiftedPath& path, const PathPlace& place) const;
  /// Joins a path at `place` without a jump: the next advance() goes one step from the last
  /// position.
  void join(const LiftedPath& path, const PathPlace& place);
  /// Moves to `place` at once. @pre the focal point is silent.
  void jump(const LiftedPath& path, const PathPlace& place);
  /// Moves to the next sample. @return the rendered pressure there. @pre a path was joined or
  /// jumped to.
  double advance();

  const Vec3& position() const { return p_D_; }
  /// Returns its position on the path so many samples from now, if it goes on round it [m].
  /// @pre a path was joined or jumped to; samples >= 0.
  Vec3 ahead(std::int64_t samples) const;
  /// Position at the end of the lap [m]. @pre a path was joined or jumped to.
  const Vec3& lap_end() const { return lap_end_; }
  bool lap_ended() const { return sample_ == lap_; }
  bool at_rest() const { return lap_ == 1; }      ///< the path is a point or shorter than one step
  bool on_path() const { return !moving_over_; }  ///< the offset is zero
  double length() const { return path_.length; }  ///< length of a lap [m]
  std::int64_t lap_samples() const { return lap_; }
  /// Returns how many samples a lap on `path` takes; 1 if it would be at rest on it.
  std::int64_t lap_samples(const LiftedPath& path) const;

  static constexpr double kMaxTransit = 20e-3;  ///< longest move from path to path [s]
  static constexpr double kMaxOffset = 10e-3;   ///< about the diameter of a focus [m]

 private:
  double step_of(const LiftedPath& path) const;
  void start(const LiftedPath& path, const PathPlace& place);
  PathPoint sample_at(double s);
  void shrink_offset(const Vec3& path_step);

  double sample_rate_ = 40e3, max_step_ = 0.2e-3;
  LiftedPath path_;
  double arc_start_ = 0.0, direction_ = 1.0;
  std::int64_t lap_ = 1, sample_ = 1;  // samples a lap, and emitted ones of it
  std::size_t edge_ = 0;               // edge that held the last sample
  bool moving_over_ = false;
  Vec3 lap_end_ = Vec3::Zero();
  Vec3 base_ = Vec3::Zero();        // on the path
  Vec3 offset_ = Vec3::Zero();      // position − base
  Vec3 p_D_ = Vec3(0.0, 0.0, 0.2);  // unused focal points rest 200 mm above the array
  Vec3 last_step_ = Vec3::Zero();
};

}  // namespace prostm
