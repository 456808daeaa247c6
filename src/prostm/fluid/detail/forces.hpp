#pragma once
/// Forces on the smoke besides pressure: buoyancy, and vorticity confinement.

#include "prostm/fluid/detail/padded_grid.hpp"

namespace prostm::fluid {

/// w += dt·β·s on the z-faces of plane k (the floor's excepted), s the smoke beside the face (F11).
void add_buoyancy(const PaddedGrid& grid, const Field& smoke, float dt_beta, Field& w, int k);

/// Computes the cell-centred velocity of plane k times `scale`.
void centre_velocity(const PaddedGrid& grid, const Field velocity[3], float scale, Field centre[3],
                     int k);

/// |∇×u| at the cells of plane k from centred differences of the centred velocity (whose halo is
/// extended), unit cells.
void vorticity_magnitude(const PaddedGrid& grid, const Field centre[3], Field& magnitude, int k);

/// force = ε (N × ω), N = ∇|ω| / |∇|ω||, at the cells of plane k (F12; Fedkiw et al. 2001), in the
/// units of `centre`.
void confinement_force(const PaddedGrid& grid, const Field centre[3], const Field& magnitude,
                       float epsilon, Field force[3], int k);

/// u += dt·f on the inner faces that plane k owns, f the mean of the cells beside.
void add_centred_force(const PaddedGrid& grid, const Field force[3], float dt, Field velocity[3],
                       int k);

}  // namespace prostm::fluid
