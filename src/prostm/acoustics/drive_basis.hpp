#pragma once
/// What the drives of a whole loop have in common.

#include <Eigen/Core>

#include "prostm/core/worker_pool.hpp"

namespace prostm {

/// Drives of a loop, or what transducers put out for them: transducers × samples, column k at the
/// k-th sample, |element| of about 1 at most.
using LoopDrives = Eigen::MatrixXcf;

/// L of C ≈ L Lᴴ, (A21), where C = Σ_k a_k a_kᴴ / K is the covariance of the drives a_k:
/// transducers × rank. Fields that an aperture can make on a hand have far fewer degrees of freedom
/// than it has transducers, and so has L few columns. It is the pivoted Cholesky factor, until no
/// transducer has more than `tolerance` of the mean of |a|² left; no column for drives that are all
/// 0. The same for any number of threads.
/// @throws std::invalid_argument with a sentence when there is no sample or no transducer, a drive
/// is not finite or above 1e6, or the tolerance is not in 1e-6 to 1: single precision has no more.
Eigen::MatrixXcf covariance_factor(const LoopDrives& drives, WorkerPool& pool, double tolerance);

/// Q of the same range as `factor` with Qᴴ Q = 1, so that a_k ≈ Q (Qᴴ a_k) as well as it can be
/// from that range. @pre the columns of `factor` are independent, as covariance_factor's are.
Eigen::MatrixXcf orthonormal(const Eigen::MatrixXcf& factor);

}  // namespace prostm
