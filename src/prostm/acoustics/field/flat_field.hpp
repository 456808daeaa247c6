#pragma once
/// The field of a whole loop of drives on a flat raster, computed at a subset of points and
/// interpolated.

#include <cstddef>
#include <span>

#include "prostm/acoustics/field/loop_field.hpp"

namespace prostm {

/// Points corner + row·down + col·right of a plane.
struct FlatRaster {
  Vec3 corner = Vec3::Zero();                        ///< [m]
  Vec3 right = Vec3::UnitX(), down = Vec3::UnitY();  ///< perpendicular steps of equal length [m]
  Vec3 normal = -Vec3::UnitZ();                      ///< unit normal of the skin
  int rows = 0, cols = 0;

  Vec3 at(double row, double col) const { return corner + row * down + col * right; }
};

/// Returns the largest spacing, in cells, of the points at which a loop's pressure is computed such
/// that interpolation (A24) is within 4e-6 of the largest pressure. 1 if every point has to be
/// computed: for large cells, points near or beside the array, or too many samples.
int flat_step(const PackedArray& packed, const FlatRaster& raster, std::size_t samples);

/// Computes the same as loop_pressure() at some points of a flat raster.
/// @param cells row·cols + col of the points. @param frames as for loop_pressure(). @throws as
/// loop_pressure() does. @pre cells lie in the raster.
LoopPressure flat_loop_pressure(const PackedArray& packed, const Medium& medium,
                                const LoopBasis& basis, const FlatRaster& raster,
                                std::span<const std::size_t> cells, int frames, WorkerPool& pool);

}  // namespace prostm
