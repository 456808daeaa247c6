#pragma once
/// Radiation pressure of a simulated array on the palm: over one lap of a focal point, or for foci.

#include <functional>
#include <vector>

#include "prostm/acoustics/array/array.hpp"
#include "prostm/acoustics/skin/skin_response.hpp"
#include "prostm/core/geometry.hpp"

namespace prostm::experiments {

/// The palm: a flat raster parallel to the array, above its centre.
struct Palm {
  SkinPatch patch{48, 48, 2e-3};
  double height = 0.2;  ///< above the array [m]

  /// Returns the centre of a cell, relative to the palm's centre [m].
  Vec2 at(int row, int col) const {
    return patch.cell * Vec2(col - 0.5 * (patch.cols - 1), row - 0.5 * (patch.rows - 1));
  }
  std::size_t cells() const { return static_cast<std::size_t>(patch.rows * patch.cols); }
};

/// A closed path of the focal point at constant speed: its position [m] at a share 0..1 of the lap.
using Lap = std::function<Vec2(double)>;
Lap circle_lap(double circumference);
Lap square_lap(double side);
/// Returns a lap back and forth along x.
Lap line_lap(double length);

/// Radiation pressure of the array at full drive over one lap: K·cells [Pa].
class StmField {
 public:
  static constexpr int kSamples = 96;  ///< K of a fast lap: harmonics up to the 47th

  StmField(const TransducerArray& array, const Palm& palm);
  /// Computes the pressure over a lap. Drives change at 40 kHz or slightly faster, so that a lap is
  /// a whole number of them. @param laps one for each simultaneous focal point; two or more are
  /// solved for equal pressures, (A16). @param samples K. @param memoryless transducers without
  /// delay; otherwise (A9).
  std::vector<double> pressure(const std::vector<Lap>& laps, double period, int samples,
                               bool memoryless) const;
  std::vector<double> pressure(const Lap& lap, double period, bool memoryless) const {
    return pressure(std::vector{lap}, period, kSamples, memoryless);
  }

 private:
  class Drives;
  TransducerArray array_;
  Palm palm_;
  Eigen::MatrixXcd to_palm_;  // cells × transducers
};

/// Returns the radiation pressure of foci at rest [Pa], solved for equal pressures at full output.
std::vector<double> foci_pressure(const TransducerArray& array, const Palm& palm,
                                  const std::vector<Vec2>& foci);

}  // namespace prostm::experiments
