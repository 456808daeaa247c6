#pragma once
/// The constants of the bodies in single precision, for kernels that take many points at once.
/// Positions are relative to an origin near the points. Private to hand.

namespace prostm {

/// A RoundCone in the form of (H9): seen from a point, its nearest sphere is at u = clamp(k /
/// generator, 0, 1) from a to b.
struct PackedCone {
  float centre[3], radius, velocity[3];  ///< the sphere at a
  float axis[3];                         ///< unit, from a to b; 0 for a sphere
  float sine, cosine;
  float per_generator;              ///< 1 / generator [1/m]; 0 for a sphere
  float length, growth, change[3];  ///< from a to b: distance, changes of radius and velocity
};

/// A SphereTriangle in the form of (H10). Its two faces are mirror images in the plane of the
/// centres. With d = p − a and y = |d·plane|, the face on p's side is at distance d·in_plane +
/// height y − radius, and p projects onto it with the weights d·dual − shear y for b and for c.
struct PackedTriangle {
  float centre[3], radius, velocity[3];  ///< the sphere at a
  float plane[3], in_plane[3], height;
  float dual_b[3], dual_c[3], shear_b, shear_c;
  float change_b[3], change_c[3];  ///< change of the velocity from a to b, to c
  PackedCone edge[3];              ///< bc, ca, ab
  bool has_faces;                  ///< false: only the edges count
};

}  // namespace prostm
