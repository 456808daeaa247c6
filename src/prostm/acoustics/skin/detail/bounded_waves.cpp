#include "prostm/acoustics/skin/detail/bounded_waves.hpp"

#include <array>

namespace prostm {
namespace {

using Triplets = std::vector<Eigen::Triplet<std::complex<double>>>;

// Bilinear elements are products of linear ones, whose stiffness is ±1/h. The mass h/12 (5, 1; 1,
// 5) gives a line of them Numerov's rule: the error of a wave number k falls as (kh)⁴, in every
// direction.
double stiffness(int a, int b) {
  return a == b ? 1.0 : -1.0;
}
double mass(int a, int b) {
  return (a == b ? 5.0 : 1.0) / 12.0;
}

}  // namespace

BoundedWaves::BoundedWaves(int rows, int cols, double step, std::span<const std::uint8_t> mask)
    : cols_(cols), corner_(static_cast<std::size_t>((rows + 1) * (cols + 1)), -1) {
  Triplets of_stiffness, of_mass;
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < cols; ++col) {
      if (mask[static_cast<std::size_t>(row * cols + col)] == 0) continue;
      std::array<int, 4> corners{};
      for (int a = 0; a < 4; ++a) {
        int& index = corner_[static_cast<std::size_t>((row + a / 2) * (cols + 1) + col + a % 2)];
        if (index < 0) index = corners_++;
        corners[static_cast<std::size_t>(a)] = index;
      }
      for (int a = 0; a < 4; ++a) {
        for (int b = 0; b < 4; ++b) {
          const double kx = stiffness(a % 2, b % 2), ky = stiffness(a / 2, b / 2);
          const double mx = mass(a % 2, b % 2), my = mass(a / 2, b / 2);
          const int i = corners[static_cast<std::size_t>(a)];
          const int j = corners[static_cast<std::size_t>(b)];
          of_stiffness.emplace_back(i, j, kx * my + ky * mx);
          of_mass.emplace_back(i, j, step * step * mx * my);
        }
      }
    }
  }
  stiffness_.resize(corners_, corners_);
  mass_.resize(corners_, corners_);
  stiffness_.setFromTriplets(of_stiffness.begin(), of_stiffness.end());
  mass_.setFromTriplets(of_mass.begin(), of_mass.end());
}

void BoundedWaves::add(std::complex<double> wave_number, std::complex<double> strength) {
  auto solver = std::make_unique<Solver>();
  solver->isSymmetric(true);
  solver->compute(stiffness_ - wave_number * wave_number * mass_);
  frequencies_.push_back({strength, std::move(solver)});
}

Eigen::VectorXcd BoundedWaves::respond(std::size_t i, const Eigen::VectorXcd& pressure) const {
  const Frequency& frequency = frequencies_[i];
  const Eigen::VectorXcd load = frequency.strength * (mass_ * pressure);
  return frequency.solver->solve(load);
}

}  // namespace prostm
