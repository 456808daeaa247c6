#pragma once
/// Response of the skin's surface to pressure: waves on a soft, lossy half-space. Equations (S1) to
/// (S5) of docs/design/skin.md.

#include <array>
#include <complex>

namespace prostm {

/// Properties of the skin, from measurements of its surface waves; none is fitted to the percept of
/// moving focal points.
struct SkinSettings {
  double slow_speed = 3.0;  ///< speed of surface waves towards 0 Hz [m/s]
  double fast_speed = 7.0;  ///< speed of surface waves towards high frequencies [m/s]
  double loss = 0.14;       ///< tan δ of the tissue's shear modulus at 1 Hz
  double density = 1100.0;  ///< [kg/m³]
};

/// Fast speeds [m/s] and tan δ in the literature: low, nominal and high.
inline constexpr std::array<double, 3> kSkinFastSpeeds = {5.0, 7.0, 10.0};
inline constexpr std::array<double, 3> kSkinLosses = {0.07, 0.14, 0.21};
/// Returns all combinations of fast speed and loss, fast speed changing slowest; [4] is nominal.
std::array<SkinSettings, 9> skin_settings_interval();

/// A soft, incompressible half-space with one relaxation time (a standard linear solid).
/// Motion is Re(W e^{+iωt}).
class SkinModel {
 public:
  /// @throws std::invalid_argument for slow_speed not in 0.5 to 50 m/s, fast_speed not in 0.5 to 50
  /// m/s or below slow_speed, loss not in 0 to 1 or above the largest possible at 1 Hz for a
  /// relaxation between the two speeds, density not in 500 to 2000 kg/m³, or a loss that is 0
  /// although the speeds differ, or above 0 although they are the same.
  explicit SkinModel(const SkinSettings& settings);

  const SkinSettings& settings() const { return settings_; }
  /// τ of the modulus [s], (S2); 0 if the skin has no loss.
  double relaxation_time() const { return relaxation_time_; }
  /// Complex shear modulus [Pa] at the angular frequency ω ≥ 0 [rad/s], (S1).
  std::complex<double> shear_modulus(double omega) const;
  /// Displacement of the surface into the skin [m] over pressure [Pa] for the pattern e^{i(kx +
  /// ωt)}, (S3). @pre wave_number k ≥ 0 [rad/m], ω ≥ 0, not both 0; with loss, or off the pole
  /// (S4).
  std::complex<double> compliance(double wave_number, double omega) const;
  /// Wave number k − iα of the surface wave e^{i(ωt − kx) − αx} [rad/m], (S4). @pre ω ≥ 0
  std::complex<double> surface_wave_number(double omega) const;
  /// Contribution of the surface wave to (S3): its pole alone, (S14). It dominates far from a load.
  /// @pre as for compliance()
  std::complex<double> wave_compliance(double wave_number, double omega) const;
  /// Strength A [1/(m Pa)] of the pole: wave_compliance = A / (k² − k_R²), (S14). @pre ω > 0
  std::complex<double> wave_strength(double omega) const;
  /// Phase speed ω / Re k [m/s] of the surface wave, (S4). @pre ω > 0
  double phase_speed(double omega) const;
  /// Complex angular frequency Ω [rad/s] of the surface wave of real wave number k > 0, which moves
  /// with Re Ω and decays as e^{−Im Ω t}, (S5). Re Ω = 0 where c_∞ > 3 c_0 and the wave is
  /// overdamped.
  std::complex<double> surface_frequency(double wave_number) const;

 private:
  SkinSettings settings_;
  double relaxation_time_ = 0.0;
};

/// (c_R/c_S)² of an incompressible half-space: the surface wave's speed over the shear wave's,
/// squared; the root of ξ³ − 8ξ² + 24ξ − 16 below 1.
inline constexpr double kRayleigh = 0.9126219746158473;

}  // namespace prostm
