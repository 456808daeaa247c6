#pragma once
/// The simulated pressure on the skin when an array emits a plan, and its score.

#include <cstddef>
#include <vector>

#include "prostm/acoustics/field/loop_field.hpp"
#include "prostm/score/loop_drives.hpp"
#include "prostm/score/score.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm {

/// The skin of a raster: its cells, with a point and a skin_normal() each.
struct SkinSurface {
  std::vector<std::size_t> cell;
  SurfacePoints points;
};
/// Returns the skin of a raster. @pre validate(raster) passes.
SkinSurface skin_surface(const TargetField& raster);

/// Returns σ of the array's focus [m] at the centre of a target's pressure on the skin, with the
/// skin's tilt there (A22); `otherwise` if there is no pressure.
double sigma_on_skin(const TransducerArray& array, const TargetField& target, double otherwise);

/// Errors of focal points' positions and levels over samples of a loop. The position is that of the
/// largest acoustic pressure within 4.5 mm along the plane; the level is the acoustic pressure over
/// the commanded one.
struct FocusAccuracy {
  int looked_at = 0;                             ///< focal points measured, in all samples
  double mean_offset = 0.0, worst_offset = 0.0;  ///< [m]
  double mean_level = 0.0, least_level = 0.0, most_level = 0.0;
};
/// Measures the focal points with an intensity above 0.1, in 64 to 127 evenly spaced samples, or in
/// all if there are fewer.
/// @param X_DP the plane along which the offsets are measured.
FocusAccuracy focus_accuracy(const PackedArray& packed, const LoopSamples& loop,
                             const LoopDriveResult& drives, const Pose& X_DP);

/// Distance from every path above which skin counts as beside the paths [m]: about twice the
/// distance of the first zero of a focus at 200 mm.
inline constexpr double kBesidePaths = 20e-3;

/// Radiation pressure of a loop on the skin [Pa]: rows·cols values at the centres of cells, 0 where
/// there is no skin. The largest values also include points between, 0.5 mm apart, so that they do
/// not depend on the cells.
struct PhysicalField {
  std::vector<double> mean, envelope;
  double largest = 0.0;       ///< maximum of the envelope
  double largest_mean = 0.0;  ///< maximum of the mean
  double side_lobe = 0.0;     ///< maximum of the envelope beside the paths, over `largest`
  int parts = 0;              ///< number of equal parts into which the loop is divided
  std::vector<double> part;   ///< mean over each part: rows·cols values, part by part
};

/// Computes the field. @param parts as `frames` of loop_pressure(). @throws std::invalid_argument
/// as LoopBasis and loop_pressure() do, and if the raster has no skin.
PhysicalField physical_field(const PackedArray& packed, const Medium& medium,
                             const TargetField& raster, const LoopSamples& loop,
                             const LoopDriveResult& drives, int parts, WorkerPool& pool);

/// Computes the metrics (Q1) to (Q7) of a physical field against a target on the same raster, after
/// scaling the field by the least-squares gain g = Σ p* p / Σ p², so that the target's unit has no
/// effect. All zeros for a target or a field without pressure. @param coverage is passed through.
Metrics score_physical(const TargetField& target, const std::vector<double>& field,
                       double coverage);

}  // namespace prostm
