#pragma once
/// Extrapolates the fluid's velocity a short way into the hands.

#include <cstdint>
#include <vector>

#include "prostm/fluid/detail/padded_grid.hpp"
#include "prostm/fluid/detail/pressure/pressure_level.hpp"

namespace prostm::fluid {

/// A shut face that gets the mean of those of its six neighbours whose bits are set.
struct ShutFace {
  Index at;
  std::uint8_t from;
};

/// The shut faces of one axis in two layers: those next to faces that the fluid passes, and those
/// next to the first layer.
struct ShutFaces {
  explicit ShutFaces(const PaddedGrid& grid) : layer(grid), stride{1, grid.row(), grid.plane()} {
    for (auto& faces : layers) faces.reserve(static_cast<std::size_t>(grid.size()));
  }
  std::vector<ShutFace> layers[2];
  std::vector<Index> deep;          ///< scratch: faces in neither layer
  PaddedField<std::uint8_t> layer;  ///< scratch: 1 for faces of the first layer
  Index stride[3];
};

/// Lists the shut faces of `axis` in the hands' box, the floor and the outer sides excepted.
void list_shut_faces(const PressureLevel& level, int axis, ShutFaces& faces);

/// Gives the listed faces the mean of the neighbouring faces that the fluid passes, two layers
/// deep; deeper ones keep the wall's velocity. Advection then finds the fluid's tangential velocity
/// behind a wall, which makes the wall slip.
void extend_into_hands(const ShutFaces& faces, Field& u);

}  // namespace prostm::fluid
