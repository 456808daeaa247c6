#pragma once
/// Motion of one focal point: along a path in whole laps of samples, and from one path to the next.

#include <cstdint>

#include "prostm/plan/lifted_plan.hpp"

namespace prostm {

/// A path's part in a loop that all focal points share, (E10), and the state of the loop's clock.
/// If `samples` is 0 there is no such loop: the path has a period of its own, (E2).
struct InStep {
  std::int64_t base = 0;     ///< samples after which a new plan may take over
  std::int64_t samples = 0;  ///< of the loop, a multiple of `base`
  std::int64_t laps = 0;     ///< of the path in the loop; 0: it rests at its first point
  std::int64_t count = 0;    ///< count of the clock, any whole number
};

/// Below this speed a focal point is at rest [m/s].
inline constexpr double kSlowest = 1e-6;

/// Returns the number of samples in a lap of a path with a period of its own, (E2): the fewest
/// whose steps are within the path's speed and max_step [m]; 1 if a focal point would be at rest on
/// it.
/// @param sample_rate [Hz]. @pre the path is measured.
std::int64_t lap_samples(const LiftedPath& path, double sample_rate, double max_step);

/// A focal point on a closed path. Sample k of a lap lies at arc length s₀ ± L k/n, where n = ⌈L /
/// step⌉ samples make a lap, (E2); so positions depend on integer counts and never drift.
///
/// A new path is joined at the place nearest to the focal point, in the direction that turns less.
/// The remaining offset between the two is carried along and shrinks in each sample by as much as
/// the largest step allows, (E3).
///
/// A path in step is traversed forwards from its first point, at the pace of the loop, and joined
/// at the place that corresponds to the loop's clock.
class FocusMotion {
 public:
  /// @param sample_rate [Hz]; @param max_step largest step between samples [m].
  void configure(double sample_rate, double max_step);

  /// Whether the offset to `place` is at most kMaxOffset and vanishes within kMaxTransit, whatever
  /// its direction.
  bool reaches(const LiftedPath& path, const PathPlace& place, const InStep& in_step = {}) const;
  /// Joins a path at `place` without a jump: the next advance() goes one step from the last
  /// position. @param in_step part of the path in a loop; then `place` is place_in_step().
  void join(const LiftedPath& path, const PathPlace& place, const InStep& in_step = {});
  /// Moves to `place` at once. @pre the focal point is silent.
  void jump(const LiftedPath& path, const PathPlace& place, const InStep& in_step = {});
  /// Moves to the next sample. @return the rendered pressure there. @pre a path was joined or
  /// jumped to.
  double advance();

  const Vec3& position() const { return p_D_; }
  /// Returns the position on the path this many samples from now if the focal point stays on it
  /// [m].
  /// @pre a path was joined or jumped to; samples >= 0.
  Vec3 ahead(std::int64_t samples) const;
  /// Whether a new plan may take over: at the end of a lap, or of the loop of a path in step.
  bool may_leave() const { return samples_left() == 0; }
  /// Samples until then.
  std::int64_t samples_left() const;
  /// Position then [m]. @pre a path was joined or jumped to.
  Vec3 leaving_place() const;
  bool lap_ended() const { return is_in_step() ? turn_ < in_step_.laps : sample_ == lap_; }
  bool is_in_step() const { return in_step_.samples > 0; }
  std::int64_t base() const { return in_step_.base; }  ///< of the loop, 0 without one
  /// The path is a point or shorter than one step.
  bool at_rest() const { return is_in_step() ? in_step_.laps == 0 : lap_ == 1; }
  bool on_path() const { return !moving_over_; }  ///< the offset is zero
  double length() const { return path_.length; }  ///< length of a lap [m]
  /// Samples of a lap; 1 at rest, rounded down in step.
  std::int64_t lap_samples() const { return lap_; }
  /// Returns the number of samples in a lap on `path`; 1 if it would be at rest on it.
  std::int64_t lap_samples(const LiftedPath& path) const {
    return prostm::lap_samples(path, sample_rate_, max_step_);
  }

  static constexpr double kMaxTransit = 20e-3;  ///< longest move from path to path [s]
  static constexpr double kMaxOffset = 10e-3;   ///< about the diameter of a focus [m]

 private:
  double step_of(const LiftedPath& path, const InStep& in_step) const;
  void start(const LiftedPath& path, const PathPlace& place, const InStep& in_step);
  double share_at(std::int64_t sample) const;
  PathPoint sample_at(double s);
  void shrink_offset(const Vec3& path_step);

  double sample_rate_ = 40e3, max_step_ = 0.2e-3;
  LiftedPath path_;
  double arc_start_ = 0.0, direction_ = 1.0;
  std::int64_t lap_ = 1,
               sample_ = 1;  // samples per lap, and emitted so far; in step: of the loop
  InStep in_step_;
  std::int64_t turn_ = 0;  // in step: progress in the lap, in samples of the loop
  std::size_t edge_ = 0;   // edge that held the last sample
  bool moving_over_ = false;
  Vec3 lap_end_ = Vec3::Zero();
  Vec3 base_ = Vec3::Zero();        // on the path
  Vec3 offset_ = Vec3::Zero();      // position − base
  Vec3 p_D_ = Vec3(0.0, 0.0, 0.2);  // unused focal points rest 200 mm above the array
  Vec3 last_step_ = Vec3::Zero();
};

}  // namespace prostm
