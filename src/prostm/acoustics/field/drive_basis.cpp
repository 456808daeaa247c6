#include "prostm/acoustics/field/drive_basis.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "prostm/acoustics/field/detail/complex_product.hpp"
#include "prostm/core/require.hpp"

namespace prostm {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr Index kChunk = 256;    // samples summed in single precision
constexpr Index kRowBlock = 48;  // rows of C per task

void check(const LoopDrives& drives) {
  if (drives.size() == 0) {
    throw std::invalid_argument("a loop has " + std::to_string(drives.rows()) +
                                " transducers and " + std::to_string(drives.cols()) +
                                " samples; it must have at least one of each");
  }
  constexpr float kMost = 1e6F;
  const auto usable = [](float x) { return std::isfinite(x) && std::abs(x) <= kMost; };
  for (Index i = 0; i < drives.size(); ++i) {
    const std::complex<float> a = drives.data()[i];
    if (usable(a.real()) && usable(a.imag())) continue;
    throw std::invalid_argument("the drive of transducer " + std::to_string(i % drives.rows()) +
                                " in sample " + std::to_string(i / drives.rows()) +
                                " (both from 0) must be finite and at most 1e6");
  }
}

/// Row-major, the order in which its blocks are computed.
using Covariance =
    Eigen::Matrix<std::complex<double>, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Adds Σ a aᴴ over some samples to the upper triangle of `sum`.
void add_covariance(const LoopDrives& drives, Index first, Index count, WorkerPool& pool,
                    Covariance& sum) {
  const Index n = drives.rows();
  const auto samples = static_cast<std::size_t>(count);
  std::vector<float> re(static_cast<std::size_t>(n) * samples), im(re.size());
  PackedMatrix adjoint(samples, static_cast<std::size_t>(n));
  for (Index k = 0; k < count; ++k) {
    for (Index i = 0; i < n; ++i) {
      const std::complex<float> a = drives(i, first + k);
      const std::size_t at = static_cast<std::size_t>(i) * samples + static_cast<std::size_t>(k);
      re[at] = a.real();
      im[at] = a.imag();
      adjoint.set(static_cast<std::size_t>(k), static_cast<std::size_t>(i), std::conj(a));
    }
  }
  const Index blocks = (n + kRowBlock - 1) / kRowBlock;
  const std::size_t cols = adjoint.cols();
  std::vector<float> z_re(static_cast<std::size_t>(blocks * kRowBlock) * cols), z_im(z_re.size());
  pool.run(static_cast<int>(blocks), [&](int block) {
    const Index top = block * kRowBlock, rows = std::min(kRowBlock, n - top);
    const std::size_t from = static_cast<std::size_t>(top);
    float* block_re = z_re.data() + from * cols;
    float* block_im = z_im.data() + from * cols;
    complex_product({re.data() + from * samples, im.data() + from * samples,
                     static_cast<std::size_t>(rows), samples},
                    adjoint, from / PackedMatrix::kPanel, block_re, block_im);
    for (Index i = 0; i < rows; ++i) {
      for (Index j = top + i; j < n; ++j) {
        const std::size_t at = static_cast<std::size_t>(i) * cols + static_cast<std::size_t>(j);
        sum(top + i, j) += std::complex<float>(block_re[at], block_im[at]);
      }
    }
  });
}

/// Returns C with both triangles filled.
Covariance covariance(const LoopDrives& drives, WorkerPool& pool) {
  Covariance c = Covariance::Zero(drives.rows(), drives.rows());
  for (Index first = 0; first < drives.cols(); first += kChunk) {
    add_covariance(drives, first, std::min(kChunk, drives.cols() - first), pool, c);
  }
  c /= static_cast<double>(drives.cols());
  c.triangularView<Eigen::StrictlyLower>() = c.adjoint();
  return c;
}

}  // namespace

Eigen::MatrixXcf covariance_factor(const LoopDrives& drives, WorkerPool& pool, double tolerance) {
  check(drives);
  require_between("tolerance", tolerance, 1e-6, 1.0);
  const MatrixXcd c = covariance(drives, pool);
  VectorXd left = c.diagonal().real();
  const double enough = tolerance * left.mean();
  MatrixXcd factor(c.rows(), c.cols());
  Index rank = 0;
  for (; rank < c.rows(); ++rank) {
    Index next = 0;
    const double most = left.maxCoeff(&next);
    if (most <= enough) break;
    // the pivot's column minus the contribution of earlier columns
    VectorXcd column = c.col(next);
    column.noalias() -= factor.leftCols(rank) * factor.row(next).head(rank).adjoint();
    factor.col(rank) = column / std::sqrt(most);
    left -= factor.col(rank).cwiseAbs2();
    left[next] = 0.0;
  }
  return factor.leftCols(rank).cast<std::complex<float>>();
}

Eigen::MatrixXcf orthonormal(const Eigen::MatrixXcf& factor) {
  // Cholesky factor of LᴴL, in double precision, since LᴴL squares the condition number
  const MatrixXcd l = factor.cast<std::complex<double>>();
  const Eigen::LLT<MatrixXcd> gram(l.adjoint() * l);
  return gram.matrixU().solve<Eigen::OnTheRight>(l).cast<std::complex<float>>();
}

}  // namespace prostm
