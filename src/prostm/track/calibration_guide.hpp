#pragma once
/// Guides the user through a calibration: marks on the array are touched one after the other with
/// the tip of an index finger.

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
  double spread = 0.0;  ///< rms spread of the fingertip while it was taken [m]
};

/// The caller passes every frame of hands to watch() and calls the rest on demand. Has no thread
/// and no clock.
class CalibrationGuide {
 public:
  /// Places marks at the corners of the transducers' outline; the user is at the front.
  /// @throws std::invalid_argument without transducers.
  explicit CalibrationGuide(std::span<const Vec3> transducers);

  /// Takes in hands in T, some dozen times a second. @param time on any increasing clock [s].
  void watch(double time, const HandFrame& hands_T);

  /// Takes the mean position of the fingertip over the last half second for a mark; a mark can be
  /// taken again. Returns an empty string, or why not: no such mark, no hand or two hands, a finger
  /// that moves (more than 5 mm rms). The tip is above the mark by the `radius` of its flesh.
  std::string take(int mark);
  /// Finds the pose from the marks taken. Returns an empty string, or why not.
  std::string solve();

  const std::vector<CalibrationMark>& marks() const { return marks_; }
  /// The pose found by solve(), unless a mark was taken since.
  const std::optional<Calibration>& result() const { return result_; }
  /// Says what to do next, or how well the pose fits.
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
