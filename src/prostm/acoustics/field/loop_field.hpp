#pragma once
/// The field of a whole loop of drives on a surface: radiation pressure on the skin.

#include <span>
#include <vector>

#include "prostm/acoustics/field/detail/complex_product.hpp"
#include "prostm/acoustics/field/drive_basis.hpp"
#include "prostm/acoustics/field/propagation_kernels.hpp"
#include "prostm/core/worker_pool.hpp"

namespace prostm {

/// Points of a surface and its unit normals there, pointing outwards, towards the sound.
struct SurfacePoints {
  std::vector<Vec3> p_D;     ///< [m]
  std::vector<Vec3> normal;  ///< one for each point
};

/// Checks a surface.
/// @throws std::invalid_argument for no point, normals that are not one per point, a coordinate
/// that is not finite, a normal whose length is not 1 within 1e-6, or a point within kNearestPoint
/// of a transducer.
void validate(const SurfacePoints& surface, const TransducerArray& array);

/// Complex rms acoustic pressure [Pa] at points for one set of drives, (A1).
/// @pre drives.size() == packed.transducers(); points as for propagation_rows.
Eigen::VectorXcf acoustic_pressure(const PackedArray& packed, std::span<const Vec3> points,
                                   const Eigen::VectorXcf& drives);

/// Radiation pressure [Pa] on a surface for one set of drives, (A20).
/// @pre as for acoustic_pressure(), validate(surface, array) passes.
std::vector<float> radiation_pressure(const PackedArray& packed, const Medium& medium,
                                      const SurfacePoints& surface, const Eigen::VectorXcf& drives);

/// Mean radiation pressure [Pa] over the loop at each point, (A20) with (A21): Σ |(G L)_m|²
/// replaces the mean of |(G a_k)_m|². For drives of focal points the error is within 1e-5 of the
/// largest pressure. The result does not depend on the number of threads.
/// @throws as validate() and covariance_factor() do, and std::invalid_argument if the drives are
/// not those of the array.
std::vector<float> mean_radiation_pressure(const PackedArray& packed, const Medium& medium,
                                           const LoopDrives& drives, const SurfacePoints& surface,
                                           WorkerPool& pool);

/// Radiation pressure over a loop [Pa].
struct LoopPressure {
  /// Initialises all values to 0. @param parts value of `frames`.
  LoopPressure(std::size_t points, int parts);
  /// Sets the values of a point. @param pressure its pressure in every sample.
  void take(std::size_t point, std::span<const float> pressure);

  std::vector<float> mean;      ///< over all samples, one per point
  std::vector<float> envelope;  ///< maximum over all samples, one per point
  int frames;                   ///< number of equal parts into which the loop is divided
  std::vector<float> frame;     ///< mean over each part: points × frames
};

/// The drives of a loop in a basis common to all samples, a_k ≈ Q Qᴴ a_k.
struct LoopBasis {
  /// @throws as covariance_factor() does, and std::invalid_argument if the drives are not those of
  /// the array.
  LoopBasis(const PackedArray& packed, const LoopDrives& drives, WorkerPool& pool);

  std::size_t samples;
  PackedMatrix factor;  ///< Q
  PackedMatrix course;  ///< Qᴴ a_k, sample by sample
};

/// Checks the number of parts into which a loop is divided.
/// @throws std::invalid_argument unless it is 0 or a divisor of the number of samples.
void validate_frames(int frames, std::size_t samples);

/// Computes every sample in the loop's basis; the error is within 2e-4 of the largest pressure.
/// @throws as validate() and validate_frames() do.
LoopPressure loop_pressure(const PackedArray& packed, const Medium& medium, const LoopBasis& basis,
                           const SurfacePoints& surface, int frames, WorkerPool& pool);

}  // namespace prostm
