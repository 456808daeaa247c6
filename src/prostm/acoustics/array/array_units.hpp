#pragma once
/// The units of a joined array, such as several AUTD3s.

#include <vector>

#include "prostm/acoustics/array/array.hpp"

namespace prostm {

/// Consecutive transducers of an array.
struct ArrayUnit {
  std::size_t first = 0, count = 0;
  Vec3 centre = Vec3::Zero();   ///< mean of the positions in D [m]
  Vec3 normal = Vec3::UnitZ();  ///< unit vector along the mean of the normals in D
};

/// Returns the units of an array in the order of its transducers: if the array is a sequence of
/// rigidly moved usx_array()s or autd3_array()s, one unit for each; else a single unit.
/// @pre validate(array) passes.
std::vector<ArrayUnit> units_of(const TransducerArray& array);

}  // namespace prostm
