#pragma once
/// The field of a whole loop of drives on a flat raster, computed at fewer points than it has.

#include <cstddef>
#include <span>

#include "prostm/acoustics/field/loop_field.hpp"

namespace prostm {

/// Points corner + row·down + col·right of a plane.
struct FlatRaster {
  Vec3 corner = Vec3::Zero();                        ///< [m]
  Vec3 right = Vec3::UnitX(), down = Vec3::UnitY();  ///< steps, perpendicular, equally long [m]
  Vec3 normal = -Vec3::UnitZ();                      ///< of the skin, a unit vector
  int rows = 0, cols = 0;

  Vec3 at(double row, double col) const { return corner + row * down + col * right; }
};

/// Returns how many cells apart the points may be that a loop's pressure is computed at, so that
/// (A24) interpolates between them within 4e-6 of the largest pressure; 1 where every point has to
/// be computed: cells that are not small, points near the array or beside it, too many samples.
int flat_step(const PackedArray& packed, const FlatRaster& raster, std::size_t samples);

/// Computes what loop_pressure() does at some points of a flat raster.
/// @param cells row·cols + col of the points. @param frames as loop_pressure()'s. @throws as
/// loop_pressure() does. @pre cells lie in the raster.
LoopPressure flat_loop_pressure(const PackedArray& packed, const Medium& medium,
                                const LoopBasis& basis, const FlatRaster& raster,
                                std::span<const std::size_t> cells, int frames, WorkerPool& pool);

}  // namespace prostm
