#include "prostm/acoustics/skin/skin_model.hpp"

#include <cmath>
#include <stdexcept>

#include "prostm/core/require.hpp"
#include "prostm/core/units.hpp"

namespace prostm {
namespace {

using Complex = std::complex<double>;

constexpr double kLossOmega = 2.0 * kPi;  // angular frequency at which `loss` is stated [rad/s]

double square(double x) {
  return x * x;
}

/// Returns the smaller τ with tan δ = ωτ(m − 1)/(1 + m ω²τ²) at 1 Hz, m the ratio of the moduli,
/// (S2): the skin relaxes well above 1 Hz.
double relaxation(const SkinSettings& s) {
  if (s.slow_speed == s.fast_speed && s.loss == 0.0) return 0.0;
  const double m = square(s.fast_speed / s.slow_speed);
  const double root = square(m - 1.0) - 4.0 * m * square(s.loss);
  if (s.loss == 0.0 || root < 0.0) {
    throw std::invalid_argument(
        "loss must be 0 if slow_speed and fast_speed are the same; otherwise it must be above 0 "
        "and at most (m - 1)/(2 sqrt(m)), the largest loss of a single relaxation between the "
        "two, where m is the square of the speeds' ratio");
  }
  return 2.0 * s.loss / ((m - 1.0 + std::sqrt(root)) * kLossOmega);
}

}  // namespace

std::array<SkinSettings, 9> skin_settings_interval() {
  std::array<SkinSettings, 9> all;
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].fast_speed = kSkinFastSpeeds[i / 3];
    all[i].loss = kSkinLosses[i % 3];
  }
  return all;
}

SkinModel::SkinModel(const SkinSettings& settings) : settings_(settings) {
  require_between("slow_speed", settings.slow_speed, 0.5, 50.0, "m/s");
  require_between("fast_speed", settings.fast_speed, settings.slow_speed, 50.0, "m/s");
  require_between("loss", settings.loss, 0.0, 1.0);
  require_between("density", settings.density, 500.0, 2000.0, "kg/m³");
  relaxation_time_ = relaxation(settings);
}

Complex SkinModel::shear_modulus(double omega) const {
  const double slow = square(settings_.slow_speed), fast = square(settings_.fast_speed);
  const Complex relaxed(0.0, omega * relaxation_time_);
  return settings_.density / kRayleigh * (slow + (fast - slow) * relaxed / (1.0 + relaxed));
}

Complex SkinModel::compliance(double wave_number, double omega) const {
  const Complex modulus = shear_modulus(omega);
  const double k = wave_number;
  const Complex shear = settings_.density * square(omega) / modulus;  // k_S²
  const Complex beta = std::sqrt(k * k - shear);  // shear waves fall off as e^{−βz}
  return k / (modulus * (4.0 * k * k * beta / (k + beta) - shear));
}

Complex SkinModel::surface_wave_number(double omega) const {
  // the root with Re k > 0 and Im k < 0, as M is in the first quadrant
  return omega * std::sqrt(settings_.density / (kRayleigh * shear_modulus(omega)));
}

Complex SkinModel::wave_strength(double omega) const {
  // the residue of (S3) at k_R is 1/(C M), since k_S² = ξ k_R² there; q is β/k
  const double q = std::sqrt(1.0 - kRayleigh);
  const double slope = 4.0 * (q + 2.0 * q * q + 1.0 / q) / square(1.0 + q);  // C
  return 2.0 * surface_wave_number(omega) / (slope * shear_modulus(omega));
}

Complex SkinModel::wave_compliance(double wave_number, double omega) const {
  const Complex pole = surface_wave_number(omega);
  return wave_strength(omega) / (wave_number * wave_number - pole * pole);
}

double SkinModel::phase_speed(double omega) const {
  return omega / surface_wave_number(omega).real();
}

Complex SkinModel::surface_frequency(double wave_number) const {
  const double slow = square(wave_number * settings_.slow_speed);
  const double fast = square(wave_number * settings_.fast_speed);
  if (relaxation_time_ == 0.0) return std::sqrt(fast);
  // s³ + s²/τ + fast s + slow/τ has a real root in [−1/τ, 0]: creep
  const double rate = 1.0 / relaxation_time_;
  double low = -rate, high = 0.0;
  for (int step = 0; step < 100; ++step) {
    const double s = 0.5 * (low + high);
    (s * s * (s + rate) + fast * s + slow * rate > 0.0 ? high : low) = s;
  }
  // the other two roots are the wave: s² + 2 d s + q
  const double d = 0.5 * (rate + low), q = fast + low * (rate + low);
  return Complex(0.0, d) + std::sqrt(Complex(q - d * d, 0.0));
}

}  // namespace prostm
