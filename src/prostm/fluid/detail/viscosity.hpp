#pragma once
/// Viscosity of the air: an explicit step of diffusion.

#include "prostm/fluid/detail/padded_grid.hpp"

namespace prostm::fluid {

/// Returns how many passes a step needs so that each is stable: 6 share ≤ 0.95 (F13).
/// @param share νΔt/h² of the whole step.
int viscous_passes(double share);

/// out = u + share ∇²u on the faces of `axis`, h = 1 (F13), in plane k. The box's sides and its
/// floor repeat the face next to them, so they exert no drag; the floor's own faces (axis 2, k = 0)
/// are copied.
/// @param share νΔt/h² of this pass.  @pre 0 ≤ k < n, or k = n for axis 2; out is not u.
void diffuse(const PaddedGrid& grid, int axis, const Field& u, float share, Field& out, int k);

}  // namespace prostm::fluid
