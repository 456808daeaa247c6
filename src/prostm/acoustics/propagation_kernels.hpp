#pragma once
/// The matrix G of (A1), for many points or a few, many times over: rows in single precision.

#include <cstddef>
#include <span>
#include <vector>

#include "prostm/acoustics/array.hpp"

namespace prostm {

/// An array and the air as the kernel reads them: transducers side by side, filled up to a multiple
/// of kRowBlock with silent ones. Constant once made; any thread may read it.
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
  std::vector<float> near_x, near_y, near_z, normal_x, normal_y, normal_z;  ///< the same in single
  std::vector<float> gain;  ///< amplitude [Pa·m], 0 for those that fill up
  /// How D(θ) is found: 1 everywhere, as a polynomial in 2 cos²θ − 1, or where that is not within
  /// 2e-7 (wide pistons, the T4010A1) from a table.
  enum class Beam { Omni, Polynomial, Table } beam = Beam::Omni;
  float polynomial[kBeamTerms] = {};
  /// D(θ) at equal steps of sin(θ/2) from 0 to sin 45°, and the rise to the next step.
  std::vector<float> directivity, rise;
  Vec3 centre = Vec3::Zero();  ///< of the transducers [m]
  double reach = 0.0;          ///< from there to the farthest transducer [m]
};

/// Rows of G, planar: re[m·stride + n] + i im[m·stride + n] is the rms acoustic pressure at point m
/// for unit drive of transducer n [Pa], (A1); 0 where transducers only fill up.
///
/// With surface normals, one for each point, unit vectors that point out of the surface, each
/// element is times the cosine of the angle at which it meets the surface, (A20), 0 where it comes
/// from behind: the rows give ρc times the normal particle velocity.
///
/// Within 1e-6 of the largest element an array can give at that distance, in amplitude and in
/// phase, at any r up to 10 m: r is computed in double precision, the rest in single. For
/// pistons with ka > 8 the directivity's table is within 1.5e-8 (ka)².
/// @pre re and im hold points.size()·stride() floats; normals are none or one a point; no point is
/// nearer than kNearestPoint to a transducer. Allocates nothing.
void propagation_rows(const PackedArray& packed, std::span<const Vec3> points,
                      std::span<const Vec3> normals, float* re, float* im);

/// The row of one point, in single precision throughout: three times as fast, and within 2e-4
/// up to r = 1 m, where k r = 730. For solvers that run for every sample.
void propagation_row_in_single(const PackedArray& packed, const Vec3& point, float* re, float* im);

/// Rows of propagation_rows, element by element through `propagate`, in double precision until it
/// is stored.
void propagation_rows_plain(const PackedArray& packed, std::span<const Vec3> points,
                            std::span<const Vec3> normals, float* re, float* im);

}  // namespace prostm
