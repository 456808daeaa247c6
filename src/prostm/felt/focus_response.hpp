#pragma once
/// The vibration that a focus of unit pressure makes in its surroundings, harmonic by harmonic:
/// (S9) and (S11) for a source that is Gaussian, weighted by the sensitivity (S6). Equation (W1) of
/// docs/design/planner-felt.md.

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "prostm/acoustics/skin/skin_model.hpp"

namespace prostm {

/// Harmonics of a loop that are felt in the plan's model.
inline constexpr int kFeltHarmonics = 8;
/// Real and imaginary parts of a value for each harmonic: first all real parts.
inline constexpr std::size_t kFeltParts = 2 * static_cast<std::size_t>(kFeltHarmonics);

/// Returns the first of the kFeltHarmonics harmonics of a loop that are felt, (W1).
/// @param period of the loop [s], > 0.
int first_felt_harmonic(double period);

/// A table over the distance from the focus's middle.
template <class Real>
struct FocusResponse {
  static constexpr double kStep = 1.5;  ///< between distances [mm]
  static constexpr int kDistances = 202;

  /// Weighted displacement per pressure [µm/Pa] at a distance, and its change over one step.
  struct alignas(64) Row {
    std::array<Real, kFeltParts> value, slope;
  };
  std::array<Row, static_cast<std::size_t>(kDistances)> row;

  /// Returns the values of all harmonics at a distance, and their slopes [1/mm]: cubic between the
  /// table's distances, those of the last one beyond. @param distance ≥ 0 [mm]
  Row at(Real distance) const;
};

/// Computes such tables. Its own table of Bessel functions is made once.
class FocusResponseMaker {
 public:
  FocusResponseMaker();

  /// Fills `out` for one skin. Allocates nothing. @param sigma of the focus [m], @param period of
  /// the loop [s]
  template <class Real>
  void make(const SkinModel& skin, double sigma, double period, FocusResponse<Real>& out);

 private:
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Matrix value_, slope_;    // J_0(k r), and −k J_1(k r) over a step: distances × wave numbers
  Matrix spectrum_;         // wave numbers × parts
  Matrix values_, slopes_;  // distances × parts
};

}  // namespace prostm
