#pragma once
/// Leads through a calibration: marks on the array are touched one after the other with the tip of
/// an index finger.

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
  double spread = 0.0;  ///< of the finger tip while it was taken, rms [m]
};

/// Who uses it calls watch() with every frame of hands, and the rest when asked. No thread, no
/// clock.
class CalibrationGuide {
 public:
  /// Marks at the corners of the transducers' outline: front is where the user is.
  /// @throws std::invalid_argument for fewer than 1.
  explicit CalibrationGuide(std::span<const Vec3> transducers);

  /// Hands in T, some dozen times a second. @param time of any clock that increases [s].
  void watch(double time, const HandFrame& hands_T);

  /// Takes the mean place of the finger tip during the last half second for a mark; a mark can be
  /// taken again. Empty, or a sentence why not: no such mark, no hand or two, a finger that moves
  /// (5 mm rms and more). The finger's flesh, `radius` of its tip, is between its tip and the mark.
  std::string take(int mark);
  /// Finds the pose from the marks that are taken. Empty, or a sentence why not.
  std::string solve();

  const std::vector<CalibrationMark>& marks() const { return marks_; }
  /// Of the last solve() that found one since a mark was taken.
  const std::optional<Calibration>& result() const { return result_; }
  /// What to do next.
  std::string sentence() const;

 private:
  struct Seen {
    double time;  // [s]
    Vec3 p_T;     // [m]
    double radius;
  };
  std::vector<CalibrationMark> marks_;
  std::vector<PointPair> pairs_;  // one per mark
  std::vector<Seen> seen_;        // of the last half second
  std::size_t hands_ = 0;         // in the last frame
  std::optional<Calibration> result_;
};

}  // namespace prostm
