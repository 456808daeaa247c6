#include "prostm/acoustics/array/array_units.hpp"

#include <cmath>

namespace prostm {
namespace {

constexpr double kSame = 1e-4;  // tolerance [m]: the resolution of files

/// Returns whether transducers first, first + 1, … are a rigidly moved copy of `unit`: distances
/// between consecutive transducers, and from each to the first one, are the same.
bool is_unit(const TransducerArray& array, std::size_t first, const TransducerArray& unit) {
  const auto same = [&](std::size_t i, std::size_t j) {
    const double there = (array.position[first + i] - array.position[first + j]).norm(),
                 here = (unit.position[i] - unit.position[j]).norm();
    return std::abs(there - here) < kSame;
  };
  for (std::size_t i = 1; i < unit.position.size(); ++i) {
    if (!same(i - 1, i) || !same(0, i)) return false;
  }
  return true;
}

bool is_sequence_of(const TransducerArray& array, const TransducerArray& unit) {
  const std::size_t size = unit.position.size();
  if (array.position.size() % size != 0) return false;
  for (std::size_t first = 0; first < array.position.size(); first += size) {
    if (!is_unit(array, first, unit)) return false;
  }
  return true;
}

ArrayUnit unit_at(const TransducerArray& array, std::size_t first, std::size_t count) {
  ArrayUnit unit{first, count};
  Vec3 normals = Vec3::Zero();
  for (std::size_t i = first; i < first + count; ++i) {
    unit.centre += array.position[i] / static_cast<double>(count);
    normals += array.normal[i];
  }
  // normals that cancel have no mean direction
  if (normals.norm() > 1e-6) unit.normal = normals.normalized();
  return unit;
}

}  // namespace

std::vector<ArrayUnit> units_of(const TransducerArray& array) {
  std::size_t size = array.position.size();
  for (const TransducerArray& unit : {usx_array(), autd3_array()}) {
    if (is_sequence_of(array, unit)) size = unit.position.size();
  }
  std::vector<ArrayUnit> units;
  for (std::size_t first = 0; first < array.position.size(); first += size)
    units.push_back(unit_at(array, first, size));
  return units;
}

}  // namespace prostm
