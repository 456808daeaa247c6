#pragma once
/// Guides the user through a calibration, in which the tip of an index finger touches marks on the
/// array one after the other.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "prostm/track/calibration.hpp"
#include "prostm/track/hand_frame.hpp"

namespace prostm {

struct CalibrationMark {
  std::string name;
  Vec3 p_D = Vec3::Zero();  ///< [m]
  bool taken = false;
  double spread = 0.0;  ///< rms spread of the fingertip while the mark was recorded [m]
};

/// Collects fingertip positions and computes the tracker's pose. The caller passes every frame of
/// hands to watch() and calls the rest on demand. Has no thread and no clock.
class CalibrationGuide {
 public:
  /// Places marks at the corners of the transducers' outline; the user is at the front.
  /// @throws std::invalid_argument without transducers.
  explicit CalibrationGuide(std::span<const Vec3> transducers);

  /// Adds a frame of hands in T, dozens of times a second. @param time on any increasing clock [s].
  void watch(double time, const HandFrame& hands_T);

  /// Records the fingertip's mean position over the last half second for a mark; a mark can be
  /// recorded again. Returns an empty string, or the reason for failure: no such mark, no hand or
  /// two hands, a finger that moves (more than 5 mm rms). The tip is above the mark by its
  /// `radius`.
  std::string take(int mark);
  /// Computes the pose from the recorded marks. Returns an empty string, or the reason for failure.
  std::string solve();

  const std::vector<CalibrationMark>& marks() const { return marks_; }
  /// The pose computed by solve(), unless a mark was recorded since.
  const std::optional<Calibration>& result() const { return result_; }
  /// Returns the next instruction for the user, or how well the pose fits.
  std::string sentence() const;

 private:
  struct Seen {
    double time;  // [s]
    Vec3 p_T;     // [m]
    double radius;
  };
  std::vector<CalibrationMark> marks_;
  std::vector<PointPair> pairs_;  // one per mark
  std::vector<Seen> seen_;        // in the last half second
  std::size_t hands_ = 0;         // number in the last frame
  std::optional<Calibration> result_;
};

}  // namespace prostm
