#pragma once
/// Response of the skin's surface to pressure: waves on a soft, lossy half-space. Equations (S1) to
/// (S5) of docs/design/skin.md.

#include <array>
#include <complex>

namespace prostm {

/// Properties of the skin, from measurements of its surface waves; none is fitted to the effects of
/// moving focal points.
struct SkinSettings {
  double slow_speed = 3.0;  ///< speed of surface waves towards 0 Hz [m/s]
  double fast_speed = 7.0;  ///< plateau of their speed at high frequencies [m/s]
  double loss = 0.14;       ///< tan δ of the tissue's shear modulus at 1 Hz
  double density = 1100.0;  ///< [kg/m³]
};

/// Plateau [m/s] and tan δ in the sources: low, nominal and high.
inline constexpr std::array<double, 3> kSkinFastSpeeds = {5.0, 7.0, 10.0};
inline constexpr std::array<double, 3> kSkinLosses = {0.07, 0.14, 0.21};
/// Returns each plateau with each loss, the plateau changing slowest; [4] is nominal.
std::array<SkinSettings, 9> skin_settings_interval();

/// A soft, incompressible half-space whose shear modulus relaxes once (a standard linear solid).
/// Motion is Re(W e^{+iωt}).
class SkinModel {
 public:
  /// @throws std::invalid_argument for slow_speed not in 0.5 to 50 m/s, fast_speed not in 0.5 to 50
  /// m/s or below slow_speed, loss not in 0 to 1 or more than any relaxation from the slow to the
  /// fast speed has at 1 Hz, density not in 500 to 2000 kg/m³. A skin without loss has one speed:
  /// loss must be 0 if both speeds are the same, and only then.
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
  /// Part of (S3) that is the surface wave: its pole alone, (S14). Far from a load it is all that
  /// is left. @pre as for compliance()
  std::complex<double> wave_compliance(double wave_number, double omega) const;
  /// Strength A [1/(m Pa)] of the pole: wave_compliance = A / (k² − k_R²), (S14). @pre ω > 0
  std::complex<double> wave_strength(double omega) const;
  /// Phase speed ω / Re k [m/s] of the surface wave, (S4). @pre ω > 0
  double phase_speed(double omega) const;
  /// Complex angular frequency Ω [rad/s] of the surface wave of real wave number k > 0, which moves
  /// with Re Ω and decays as e^{−Im Ω t}, (S5). Re Ω = 0 where c_∞ > 3 c_0 and the wave creeps.
  std::complex<double> surface_frequency(double wave_number) const;

 private:
  SkinSettings settings_;
  double relaxation_time_ = 0.0;
};

/// (c_R/c_S)² of an incompressible half-space: the surface wave's speed over the shear wave's,
/// squared; the root of ξ³ − 8ξ² + 24ξ − 16 below 1.
inline constexpr double kRayleigh = 0.9126219746158473;

}  // namespace prostm
