#pragma once
/// The field of a whole loop of drives on a surface: radiation pressure on the skin.

#include <span>
#include <vector>

#include "prostm/acoustics/drive_basis.hpp"
#include "prostm/acoustics/propagation_kernels.hpp"
#include "prostm/core/worker_pool.hpp"

namespace prostm {

/// Points of a surface with its unit normals, which point out of it, towards the sound.
struct SurfacePoints {
  std::vector<Vec3> p_D;     ///< [m]
  std::vector<Vec3> normal;  ///< one for each point
};

/// @throws std::invalid_argument with a sentence: no point, not a normal for each, one that is not
/// finite, a normal whose length is not 1 within 1e-6, a point within kNearestPoint of a
/// transducer.
void validate(const SurfacePoints& surface, const TransducerArray& array);

/// Complex rms acoustic pressure [Pa] at points for one set of drives, (A1).
/// @pre drives.size() == packed.transducers(); points as for propagation_rows.
Eigen::VectorXcf acoustic_pressure(const PackedArray& packed, std::span<const Vec3> points,
                                   const Eigen::VectorXcf& drives);

/// Radiation pressure [Pa] on a surface for one set of drives, (A20).
/// @pre as for acoustic_pressure(), validate(surface, array) passes.
std::vector<float> radiation_pressure(const PackedArray& packed, const Medium& medium,
                                      const SurfacePoints& surface, const Eigen::VectorXcf& drives);

/// Mean radiation pressure [Pa] over the loop at each point, (A20) with (A21): Σ |(G L)_m|² instead
/// of the mean of |(G a_k)_m|²; within 1e-5 of the largest for drives of focal points. The same for
/// any number of threads.
/// @throws as validate() and covariance_factor() do, and std::invalid_argument when the drives are
/// not those of the array.
std::vector<float> mean_radiation_pressure(const PackedArray& packed, const Medium& medium,
                                           const LoopDrives& drives, const SurfacePoints& surface,
                                           WorkerPool& pool);

/// Radiation pressure over a loop [Pa].
struct LoopPressure {
  std::vector<float> mean;      ///< over all samples, one a point
  std::vector<float> envelope;  ///< the largest of all samples, one a point
  int frames = 0;               ///< parts of equal length that the loop was cut in
  std::vector<float> frame;     ///< mean over each part: points × frames
};

/// Every sample through the same basis, a_k ≈ Q Qᴴ a_k; within 2e-4 of the largest. @param frames
/// 0, or a divisor of the number of samples. @throws as mean_radiation_pressure() does, and
/// std::invalid_argument for frames that are neither.
LoopPressure loop_pressure(const PackedArray& packed, const Medium& medium,
                           const LoopDrives& drives, const SurfacePoints& surface, int frames,
                           WorkerPool& pool);

}  // namespace prostm
