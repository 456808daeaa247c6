#pragma once
/// The units, such as several AUTD3s, that an array is joined from.

#include <vector>

#include "prostm/acoustics/array/array.hpp"

namespace prostm {

/// Consecutive transducers of an array.
struct ArrayUnit {
  std::size_t first = 0, count = 0;
  Vec3 centre = Vec3::Zero();   ///< mean of the positions in D [m]
  Vec3 normal = Vec3::UnitZ();  ///< unit vector along the mean of the normals in D
};

/// Returns the units of an array in the order of its transducers: as many as it is a sequence of
/// usx_array()s or of autd3_array()s, each moved as a whole; else one.
/// @pre validate(array) accepts it.
std::vector<ArrayUnit> units_of(const TransducerArray& array);

}  // namespace prostm
