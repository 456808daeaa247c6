#pragma once
/// A basis of the drives of a whole loop.

#include <Eigen/Core>

#include "prostm/core/worker_pool.hpp"

namespace prostm {

/// Drives of a loop, or the transducers' outputs for them: transducers × samples. Column k is the
/// k-th sample; elements have magnitudes of about 1 at most.
using LoopDrives = Eigen::MatrixXcf;

/// Returns L with C ≈ L Lᴴ, (A21), where C = Σ_k a_k a_kᴴ / K is the covariance of the drives a_k:
/// transducers × rank. L has few columns, because the fields that an aperture can make on a hand
/// have far fewer degrees of freedom than it has transducers. L is the pivoted Cholesky factor,
/// continued until the residual of every transducer is at most `tolerance` times the mean of |a|²;
/// it has no column if all drives are 0. The result does not depend on the number of threads.
/// @throws std::invalid_argument if there is no sample or no transducer, a drive is not finite or
/// above 1e6, or the tolerance is not in 1e-6 (the limit of single precision) to 1.
Eigen::MatrixXcf covariance_factor(const LoopDrives& drives, WorkerPool& pool, double tolerance);

/// Returns Q with the range of `factor` and Qᴴ Q = 1: Q (Qᴴ a_k) is the best approximation of a_k
/// in that range. @pre the columns of `factor` are independent, like those of covariance_factor().
Eigen::MatrixXcf orthonormal(const Eigen::MatrixXcf& factor);

}  // namespace prostm
