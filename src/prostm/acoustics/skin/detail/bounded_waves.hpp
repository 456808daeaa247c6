#pragma once
/// Time-harmonic waves on a plate that ends at the outline of a mask, (S15) and (S16) of
/// docs/design/skin.md.

#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <complex>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace prostm {

/// A mesh of the square elements of a mask; their corners are the nodes of the displacement.
class BoundedWaves {
 public:
  /// @param mask rows·cols, row-major; not 0 where there is plate. @param step edge of an element
  /// [m]. @pre rows, cols ≥ 1, step > 0, at least one element is plate
  BoundedWaves(int rows, int cols, double step, std::span<const std::uint8_t> mask);

  /// Index of the corner at (row, col), 0..rows and 0..cols, or −1 off the plate.
  int corner(int row, int col) const {
    return corner_[static_cast<std::size_t>(row * (cols_ + 1) + col)];
  }
  int corners() const { return corners_; }

  /// Removes all frequencies.
  void clear() { frequencies_.clear(); }
  /// Adds a frequency: waves of wave number k and strength A. Slow: factors a matrix.
  /// @pre Im k < 0, so that free waves decay
  void add(std::complex<double> wave_number, std::complex<double> strength);
  /// Solves ∇²W + k²W = −A P with free edges for the i-th frequency that was added. Allocates.
  /// @param pressure P at the corners [Pa]. @return W at the corners [m]
  Eigen::VectorXcd respond(std::size_t i, const Eigen::VectorXcd& pressure) const;

 private:
  using Matrix = Eigen::SparseMatrix<std::complex<double>>;
  using Solver = Eigen::SparseLU<Matrix>;
  struct Frequency {
    std::complex<double> strength;
    std::unique_ptr<Solver> solver;  // a solver can neither be copied nor moved
  };

  int cols_, corners_ = 0;
  std::vector<int> corner_;
  Matrix stiffness_, mass_;
  std::vector<Frequency> frequencies_;
};

}  // namespace prostm
