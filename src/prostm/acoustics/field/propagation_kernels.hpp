#pragma once
/// Rows of the matrix G of (A1) in single precision, for many points or many calls.

#include <cstddef>
#include <span>
#include <vector>

#include "prostm/acoustics/array/array.hpp"

namespace prostm {

/// An array and the air in the kernel's layout: one array per coordinate, padded with silent
/// transducers to a multiple of kRowBlock. Constant after construction; any thread may read it.
struct PackedArray {
  static constexpr std::size_t kRowBlock = 16;
  /// Steps of the directivity's table.
  static constexpr int kDirectivitySteps = 2048;
  static constexpr int kBeamTerms = 8;

  /// @throws as validate(array) does.
  PackedArray(const TransducerArray& array, const Medium& medium);

  std::size_t transducers() const { return array.position.size(); }
  /// Floats from one row to the next: transducers() rounded up to a multiple of kRowBlock.
  std::size_t stride() const { return gain.size(); }

  TransducerArray array;
  Wave wave;
  std::vector<double> x, y, z, square;  ///< positions in D [m], and x² + y² + z²
  /// Positions and normals in single precision.
  std::vector<float> near_x, near_y, near_z, normal_x, normal_y, normal_z;
  std::vector<float> gain;  ///< amplitude [Pa·m], 0 for padding
  /// Representation of D(θ): 1 everywhere, a polynomial in 2 cos²θ − 1, or a table if the error of
  /// the polynomial exceeds 2e-7 (wide pistons, the T4010A1).
  enum class Beam { Omni, Polynomial, Table } beam = Beam::Omni;
  float polynomial[kBeamTerms] = {};
  /// D(θ) at equal steps of sin(θ/2) from 0 to sin 45°, and the difference to the next step.
  std::vector<float> directivity, rise;
  Vec3 centre = Vec3::Zero();  ///< mean position of the transducers [m]
  double reach = 0.0;          ///< distance from `centre` to the farthest transducer [m]
};

/// Computes rows of G: re[m·stride + n] + i im[m·stride + n] is the rms acoustic pressure at point
/// m for unit drive of transducer n [Pa], (A1); 0 for padding.
///
/// With surface normals, one outward unit vector for each point, each element is multiplied by the
/// cosine of its angle of incidence, (A20), or by 0 if it comes from behind: the rows give ρc times
/// the normal particle velocity.
///
/// The error in amplitude and phase is within 1e-6 of the largest element possible at that
/// distance, at any r up to 10 m: r is computed in double precision, the rest in single. For
/// pistons with ka > 8 the directivity's table is within 1.5e-8 (ka)².
/// @pre re and im hold points.size()·stride() floats; normals is empty or has one per point; no
/// point is nearer than kNearestPoint to a transducer. Allocates nothing.
void propagation_rows(const PackedArray& packed, std::span<const Vec3> points,
                      std::span<const Vec3> normals, float* re, float* im);

/// Computes the row of one point in single precision throughout: three times as fast, and within
/// 2e-4 up to r = 1 m, where k r = 730. For solvers that run at every sample.
void propagation_row_in_single(const PackedArray& packed, const Vec3& point, float* re, float* im);

/// Reference for propagation_rows(): calls `propagate` for each element, in double precision.
void propagation_rows_plain(const PackedArray& packed, std::span<const Vec3> points,
                            std::span<const Vec3> normals, float* re, float* im);

}  // namespace prostm
