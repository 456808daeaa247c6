#pragma once
/// The fluid's velocity carried a little way into the hands.

#include <cstdint>
#include <vector>

#include "prostm/fluid/detail/padded_grid.hpp"
#include "prostm/fluid/detail/pressure_level.hpp"

namespace prostm::fluid {

/// Scratch for the shut faces of one axis.
struct ShutFaces {
  explicit ShutFaces(const PaddedGrid& grid) : layer(grid) {
    at.reserve(static_cast<std::size_t>(grid.size()));
  }
  std::vector<Index> at;
  PaddedField<std::uint8_t> layer;  ///< one byte per face, all 0 between calls
};

/// Lists the shut faces of `axis` in the hands' box, the floor and the outer sides excepted.
void list_shut_faces(const PressureLevel& level, int axis, std::vector<Index>& shut);

/// Gives the listed faces of `axis` the mean of the neighbouring faces that the fluid passes, two
/// layers deep; deeper ones keep the wall's velocity. Advection then finds the fluid's tangential
/// velocity behind a wall, which makes the wall slip.
void extend_into_hands(const PressureLevel& level, int axis, Field& u, ShutFaces& faces);

}  // namespace prostm::fluid
