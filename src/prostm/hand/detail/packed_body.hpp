#pragma once
/// The constants of the bodies in single precision, for kernels that take many points at once.
/// Positions are relative to an origin near the points. Private to hand.

namespace prostm {

/// A RoundCone as (H9): seen from a point, its nearest sphere is at u = clamp(k / generator, 0, 1)
/// from a to b.
struct PackedCone {
  float centre[3], radius, velocity[3];  ///< of the sphere at a
  float axis[3];                         ///< unit, from a to b; 0 for a sphere
  float sine, cosine;
  float per_generator;              ///< 1 / generator [1/m]; 0 for a sphere
  float length, growth, change[3];  ///< from a to b: distance, of the radius, of the velocity
};

/// A SphereTriangle as (H10). Its two faces are mirror images in the plane of the centres, so with
/// d = p − a, y = |d·plane| the one on p's side is at d·in_plane + height y − radius, and p falls
/// on it with the weights d·dual − shear y of b and of c.
struct PackedTriangle {
  float centre[3], radius, velocity[3];  ///< of the sphere at a
  float plane[3], in_plane[3], height;
  float dual_b[3], dual_c[3], shear_b, shear_c;
  float change_b[3], change_c[3];  ///< of the velocity from a to b, to c
  PackedCone edge[3];              ///< bc, ca, ab
  bool has_faces;                  ///< false: the edges alone
};

}  // namespace prostm
