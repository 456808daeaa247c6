#include "prostm/felt/focus_response.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "prostm/acoustics/skin/skin_percept.hpp"
#include "prostm/core/units.hpp"

namespace prostm {
namespace {

constexpr double kLowest = 90.0;         // lowest frequency of the model [Hz]
constexpr double kWaveNumberStep = 4.0;  // [rad/m]: a third of the pole's width due to the loss
constexpr int kWaveNumbers = 320;        // up to 1280 rad/m, where the spectrum of a focus vanishes
constexpr double kMicro = 1e6;           // µm per m

double wave_number(Eigen::Index m) {
  return kWaveNumberStep * static_cast<double>(m + 1);
}

}  // namespace

int first_felt_harmonic(double period) {
  return std::max(1, static_cast<int>(std::ceil(kLowest * period - 1e-9)));
}

template <class Real>
typename FocusResponse<Real>::Row FocusResponse<Real>::at(Real distance) const {
  const auto step = static_cast<Real>(kStep);
  const Real place = std::min(distance / step, static_cast<Real>(kDistances - 1));
  const auto low = std::min(static_cast<std::size_t>(place), row.size() - 2);
  const Row &a = row[low], &b = row[low + 1];
  const Real t = place - static_cast<Real>(low), u = 1 - t;
  // Hermite's cubic and its derivative
  const Real va = (1 + 2 * t) * u * u, sa = t * u * u, vb = t * t * (3 - 2 * t), sb = -t * t * u;
  const Real dv = 6 * t * u / step, da = u * (1 - 3 * t) / step, db = t * (3 * t - 2) / step;
  Row out;
  for (std::size_t i = 0; i < kFeltParts; ++i) {
    out.value[i] = va * a.value[i] + sa * a.slope[i] + vb * b.value[i] + sb * b.slope[i];
    out.slope[i] = dv * (b.value[i] - a.value[i]) + da * a.slope[i] + db * b.slope[i];
  }
  return out;
}

FocusResponseMaker::FocusResponseMaker() {
  constexpr int kRows = FocusResponse<double>::kDistances;
  constexpr double kMetre = 1e-3 * FocusResponse<double>::kStep;
  value_.resize(kRows, kWaveNumbers);
  slope_.resize(kRows, kWaveNumbers);
  for (Eigen::Index r = 0; r < kRows; ++r) {
    for (Eigen::Index m = 0; m < kWaveNumbers; ++m) {
      const double k = wave_number(m), phase = k * kMetre * static_cast<double>(r);
      value_(r, m) = j0(phase);
      slope_(r, m) = -k * kMetre * j1(phase);
    }
  }
  spectrum_.resize(kWaveNumbers, static_cast<Eigen::Index>(kFeltParts));
  values_.resize(kRows, static_cast<Eigen::Index>(kFeltParts));
  slopes_.resize(kRows, static_cast<Eigen::Index>(kFeltParts));
}

template <class Real>
void FocusResponseMaker::make(const SkinModel& skin, double sigma, double period,
                              FocusResponse<Real>& out) {
  const int first = first_felt_harmonic(period);
  for (int n = 0; n < kFeltHarmonics; ++n) {
    const double frequency = (first + n) / period, omega = 2.0 * kPi * frequency;
    const double felt = kMicro * pacinian_sensitivity(frequency) / std::sqrt(2.0);
    for (Eigen::Index m = 0; m < kWaveNumbers; ++m) {
      const double k = wave_number(m), spread = k * sigma;
      const double focus = sigma * sigma * std::exp(-0.5 * spread * spread) * k * kWaveNumberStep;
      const std::complex<double> value = felt * focus * skin.compliance(k, omega);
      spectrum_(m, n) = value.real();
      spectrum_(m, n + kFeltHarmonics) = value.imag();
    }
  }
  // lazy products need no temporary
  values_ = value_.lazyProduct(spectrum_);
  slopes_ = slope_.lazyProduct(spectrum_);
  for (std::size_t r = 0; r < out.row.size(); ++r) {
    for (std::size_t i = 0; i < kFeltParts; ++i) {
      const auto at = static_cast<Eigen::Index>(r), part = static_cast<Eigen::Index>(i);
      out.row[r].value[i] = static_cast<Real>(values_(at, part));
      out.row[r].slope[i] = static_cast<Real>(slopes_(at, part));
    }
  }
}

template struct FocusResponse<float>;
template struct FocusResponse<double>;
template void FocusResponseMaker::make(const SkinModel&, double, double, FocusResponse<float>&);
template void FocusResponseMaker::make(const SkinModel&, double, double, FocusResponse<double>&);

}  // namespace prostm
