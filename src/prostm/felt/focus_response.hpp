#pragma once
/// The vibration around a focus of unit pressure, by harmonics: (S9) and (S11) for a Gaussian
/// source, weighted by the sensitivity (S6). Equation (W1) of
/// docs/design/planner-felt.md.

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "prostm/acoustics/skin/skin_model.hpp"

namespace prostm {

/// Number of harmonics of a loop in the planner's model of the percept.
inline constexpr int kFeltHarmonics = 8;
/// Number of real and imaginary parts of all harmonics, stored with all real parts first.
inline constexpr std::size_t kFeltParts = 2 * static_cast<std::size_t>(kFeltHarmonics);

/// Returns the first of the kFeltHarmonics harmonics of a loop in the model, (W1).
/// @param period period of the loop [s], > 0.
int first_felt_harmonic(double period);

/// Weighted displacement per pressure [µm/Pa], a cubic of the distance from the focus's centre
/// within each step of a table.
template <class Real>
struct FocusResponse {
  static constexpr double kStep = 1.5;  ///< step of the distances [mm]
  static constexpr int kDistances = 202;

  /// All parts at a distance, and their derivatives [1/mm].
  struct Parts {
    std::array<Real, kFeltParts> value, slope;
  };
  /// Coefficients of 1, t, t² and t³ within a step, t from 0 to 1.
  struct alignas(64) Cubic {
    std::array<std::array<Real, kFeltParts>, 4> by_power;
  };
  std::array<Cubic, static_cast<std::size_t>(kDistances - 1)> cubic;
  Real largest;  ///< magnitude of the values at the ends of the steps

  /// Returns the values at a distance, constant beyond the last one. @param distance ≥ 0 [mm]
  Parts at(Real distance) const;
};

/// Computes FocusResponse tables. The constructor tabulates the Bessel functions.
class FocusResponseMaker {
 public:
  FocusResponseMaker();

  /// Fills `out` for one skin. Allocates nothing. @param sigma σ of the focus [m]. @param period
  /// period of the loop [s]
  template <class Real>
  void make(const SkinModel& skin, double sigma, double period, FocusResponse<Real>& out);

 private:
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Matrix value_, slope_;    // J_0(k r), and −k J_1(k r) per step: distances × wave numbers
  Matrix spectrum_;         // wave numbers × parts
  Matrix values_, slopes_;  // distances × parts
};

}  // namespace prostm
