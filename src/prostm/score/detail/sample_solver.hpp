#pragma once
/// Sample-by-sample solver for the drives of focal points.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "prostm/acoustics/focus/focus_solver.hpp"
#include "prostm/emit/focus_sample.hpp"

namespace prostm {

/// The non-silent focal points of a sample, each with its index; of two within kNearestFoci only
/// the stronger.
struct Sounding {
  std::vector<Vec3> p_D;
  std::vector<double> intensity;
  std::vector<std::size_t> focus;
  int merged = 0;

  explicit Sounding(std::span<const FocusSample> foci);
};

/// Solves sample after sample, each starting from the previous phases of the focal points.
class SampleSolver {
 public:
  /// @param array, medium outlive this.
  SampleSolver(const TransducerArray& array, const Medium& medium, const FocusSettings& settings,
               int foci);

  /// @throws std::invalid_argument as propagation_to() and solve_foci() do. @pre some focal point
  /// is not silent
  FocusSolution solve(const Sounding& s);
  /// Errors of the focal points' shares in the last sample.
  const Eigen::VectorXd& errors() const { return errors_; }
  /// Returns the acoustic pressure per intensity that a solution reaches with full drives [Pa,
  /// rms].
  static double reached(const FocusSolution& solution);

 private:
  const TransducerArray& array_;
  const Medium& medium_;
  const FocusSettings settings_;
  Eigen::VectorXd phase_, errors_;
};

}  // namespace prostm
