#pragma once
/// Estimates how far the pressure next to hands is from that of a converged solve.

#include <vector>

#include "prostm/fluid/detail/pressure/pressure_level.hpp"

namespace prostm::fluid {

/// Compares the pressure in the cells of the rows that hands cut from iterate to iterate. If each
/// iteration leaves the share ρ of the error, the last one, which changed the pressure by d, leaves
/// d ρ/(1 − ρ), (F16) of docs/design/fluid.md; ρ is the ratio of the last two changes.
class Convergence {
 public:
  explicit Convergence(const PaddedGrid& grid);

  /// Starts a solve.
  void begin();
  /// Stores the pressure before one of the last two iterations.
  void keep(const PressureLevel& level, const Field& p);
  /// Compares the pressure after that iteration with it. @pre after keep(), with the same level.
  void compare(const PressureLevel& level, const Field& p);

  /// Estimated rms error over the rms pressure there; 0 without hands.
  double error() const;

 private:
  std::vector<float> kept_;  // stored pressures in the order of the cells; room for all cells
  int iterations_ = 0;
  double before_ = 0.0, last_ = 0.0;  // Σ of the squared changes of the last two
  double pressure_ = 0.0;             // Σ of the squared pressures
};

}  // namespace prostm::fluid
