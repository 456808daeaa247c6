#pragma once
/// The real array's radiation pressure on the palm over one lap of a focal point, or of modulated
/// foci.

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

  /// Returns the centre of a cell [m] from the palm's middle.
  Vec2 at(int row, int col) const {
    return patch.cell * Vec2(col - 0.5 * (patch.cols - 1), row - 0.5 * (patch.rows - 1));
  }
  std::size_t cells() const { return static_cast<std::size_t>(patch.rows * patch.cols); }
};

/// A closed path of the focal point at constant speed: its place [m] at a share 0..1 of the lap.
using Lap = std::function<Vec2(double)>;
Lap circle_lap(double circumference);
Lap square_lap(double side);
/// To and fro along x.
Lap line_lap(double length);

/// Radiation pressure of the array at full drive over one lap: K·cells [Pa].
class StmField {
 public:
  static constexpr int kSamples = 96;  ///< K: harmonics up to the 47th

  StmField(const TransducerArray& array, const Palm& palm);
  /// @param memoryless transducers follow at once, otherwise by (A9). Drives change at 40 kHz or a
  /// little faster, so that a lap is a whole number of them.
  std::vector<double> pressure(const Lap& lap, double period, bool memoryless) const;

 private:
  TransducerArray array_;
  Palm palm_;
  Eigen::MatrixXcd to_palm_;  // cells × transducers
};

/// Returns the radiation pressure at rest [Pa] of these foci, solved for equal pressures and as
/// strong as one common factor of the drives allows.
std::vector<double> foci_pressure(const TransducerArray& array, const Palm& palm,
                                  const std::vector<Vec2>& foci);

}  // namespace prostm::experiments
