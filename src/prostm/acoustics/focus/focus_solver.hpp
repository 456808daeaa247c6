#pragma once
/// Drives of an array for several simultaneous focal points.

#include <array>
#include <string_view>

#include "prostm/acoustics/field/propagation.hpp"
#include "prostm/core/text/names.hpp"

namespace prostm {

enum class FocusMethod {
  Superposition,  ///< (A11): the naive foci, added
  Ibp,            ///< (A12): iterative back-propagation, phases only [Marzo and Drinkwater 2019]
  GsPat,          ///< (A13): Gerchberg-Saxton on the focal points [Plasencia et al. 2020]
  Weighted,  ///< (A16): weighted Gerchberg-Saxton on phases only [Di Leonardo et al. 2007], (A17)
  /// (A14): phases of the dominant eigenvector, then least squares with Tikhonov's regularisation
  /// [Long et al. 2014]
  Eigenvector,
  LevenbergMarquardt  ///< (A15): phases only, to convergence; the slow reference
};

template <>
inline constexpr std::array<std::string_view, 6> kNames<FocusMethod> = {
    "superposition", "ibp", "gs-pat", "weighted", "eigenvector", "lm"};

struct FocusSettings {
  FocusMethod method = FocusMethod::Weighted;
  /// Iterations of Ibp, GsPat and Weighted; LevenbergMarquardt may take 50 times as many.
  int iterations = 20;
  double regularisation = 1.0;  ///< γ of Eigenvector, 0..1
};

struct FocusSolution {
  Eigen::VectorXcd drive;     ///< q, N; |q_n| <= 1
  Eigen::VectorXcd pressure;  ///< G q [Pa, rms], M
  double level = 0.0;         ///< reached share of the targets as a whole: Σ a |Gq| / Σ a²
};

/// Finds drives whose pressures at the focal points have the magnitudes `target`. If the array
/// cannot reach them, all are scaled by the largest common factor that satisfies |q| ≤ 1; none is
/// clipped individually.
/// @param target a, M [Pa, rms].
/// @param start initial phases [rad] of the focal points, M; 0 if empty. Pass the phases of the
/// previous solution to avoid jumps of the drives.
/// @throws std::invalid_argument for sizes that disagree, no focal point or more than transducers,
/// a target that is negative or not finite, no target above 0, and a focal point that no transducer
/// reaches.
FocusSolution solve_foci(const Propagation& propagation, const Eigen::VectorXd& target,
                         const FocusSettings& settings, const Eigen::VectorXd& start = {});

/// Relative error of each focal point with target > 0, |p_m| / (level · a_m) − 1; 0 for the others.
Eigen::VectorXd focus_errors(const FocusSolution& solution, const Eigen::VectorXd& target);

}  // namespace prostm
