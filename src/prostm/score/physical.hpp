#pragma once
/// What an array really puts on the skin when it plays a plan, and how good that is.

#include <cstddef>
#include <vector>

#include "prostm/acoustics/loop_field.hpp"
#include "prostm/score/loop_drives.hpp"
#include "prostm/score/score.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm {

/// The skin of a raster: its cells, and for each a point and its skin_normal.
struct SkinSurface {
  std::vector<std::size_t> cell;
  SurfacePoints points;
};
/// @pre validate(raster) passes.
SkinSurface skin_surface(const TargetField& raster);

/// How near focal points are to where and how strong they should be, over samples of a loop. The
/// place is that of the largest acoustic pressure within 4.5 mm along the plane; the level is
/// acoustic pressure over what the sample asks for.
struct FocusAccuracy {
  int looked_at = 0;                             ///< focal points, in all samples looked at
  double mean_offset = 0.0, worst_offset = 0.0;  ///< [m]
  double mean_level = 0.0, least_level = 0.0, most_level = 0.0;
};
/// Of focal points with an intensity above 0.1, in up to 64 samples of equal distance.
/// @param X_DP the plane along which a focus may be off.
FocusAccuracy focus_accuracy(const PackedArray& packed, const LoopSamples& loop,
                             const LoopDriveResult& drives, const Pose& X_DP);

/// Cells of the skin farther from every path than this are beside it: twice the distance of the
/// first zero of a focus at 200 mm, about [m].
inline constexpr double kBesidePaths = 20e-3;

/// Radiation pressure of a loop on the skin [Pa]: rows·cols values at the middles of cells, 0 where
/// there is no skin. The largest values are those between them too, found on points 0.5 mm apart,
/// so that they do not depend on the cells.
struct PhysicalField {
  std::vector<double> mean, envelope;
  double largest = 0.0;       ///< of the envelope
  double largest_mean = 0.0;  ///< of the mean
  double side_lobe = 0.0;     ///< largest of the envelope beside the paths, over `largest`
};

/// @throws std::invalid_argument as loop_pressure() does, and when the raster has no skin.
PhysicalField physical_field(const PackedArray& packed, const Medium& medium,
                             const TargetField& raster, const LoopSamples& loop,
                             const LoopDriveResult& drives, WorkerPool& pool);

/// The metrics (Q1) to (Q7) of a physical field against a target on the same raster, after the gain
/// g of least squares, Σ p* p / Σ p²: units of targets are free. All zeros for a target or a field
/// without pressure. @param coverage is passed through.
Metrics score_physical(const TargetField& target, const std::vector<double>& field,
                       double coverage);

}  // namespace prostm
