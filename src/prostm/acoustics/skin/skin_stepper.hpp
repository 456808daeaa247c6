#pragma once
/// Time-domain model of the skin, for one wave number along the surface at a time: the slow
/// reference for the harmonic sum.

#include <Eigen/SparseCholesky>

#include "prostm/acoustics/skin/skin_model.hpp"

namespace prostm {

/// Steps the half-space from rest under the pressure P(t) cos(kx) on its surface, (S12): finite
/// elements in depth for the displacement, central differences in time. Shares only the material
/// with (S3).
class SkinStepper {
 public:
  /// @param step [s]: errors fall with (ω · step)². @throws std::invalid_argument with a message:
  /// wave_number not in 1 to 5000 rad/m, step not above 0 or too long for this wave number.
  SkinStepper(const SkinModel& model, double wave_number, double step);

  /// Advances one time step under the pressure at the step's beginning [Pa].
  void step(double pressure);
  /// Current displacement of the surface into the skin [m], the amplitude of cos(kx).
  double displacement() const { return now_[0]; }

 private:
  using Matrix = Eigen::SparseMatrix<double>;

  double step_;
  double slow_, rise_;   // c_0²/ξ and (c_∞² − c_0²)/ξ [m²/s²]
  double keep_, renew_;  // factors of the memory per step
  double load_;          // factor on the pressure: one over the density [m³/kg]
  // degrees of freedom: w and its slope at each node, from the surface down
  Matrix stiffness_, receding_;  // K, and M − C step/2
  Matrix mass_;
  Eigen::SimplicialLDLT<Matrix> solver_;  // for M + C step/2
  Eigen::VectorXd now_, before_, memory_, force_, next_;
};

}  // namespace prostm
