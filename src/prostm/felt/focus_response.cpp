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
typename FocusResponse<Real>::Parts FocusResponse<Real>::at(Real distance) const {
  const auto step = static_cast<Real>(kStep);
  const Real place = std::min(distance / step, static_cast<Real>(kDistances - 1));
  const auto low = std::min(static_cast<std::size_t>(place), cubic.size() - 1);
  const Real t = place - static_cast<Real>(low);
  const auto& by = cubic[low].by_power;
  Parts out;
  for (std::size_t i = 0; i < kFeltParts; ++i) {
    out.value[i] = by[0][i] + t * (by[1][i] + t * (by[2][i] + t * by[3][i]));
    out.slope[i] = (by[1][i] + t * (2 * by[2][i] + t * 3 * by[3][i])) / step;
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
  out.largest = static_cast<Real>(values_.cwiseAbs().maxCoeff());
  for (std::size_t r = 0; r < out.cubic.size(); ++r) {
    auto& by = out.cubic[r].by_power;
    for (std::size_t i = 0; i < kFeltParts; ++i) {
      const auto at = static_cast<Eigen::Index>(r), part = static_cast<Eigen::Index>(i);
      // Hermite's cubic
      const double value = values_(at, part), rise = values_(at + 1, part) - value;
      const double slope = slopes_(at, part), next = slopes_(at + 1, part);
      by[0][i] = static_cast<Real>(value);
      by[1][i] = static_cast<Real>(slope);
      by[2][i] = static_cast<Real>(3.0 * rise - 2.0 * slope - next);
      by[3][i] = static_cast<Real>(slope + next - 2.0 * rise);
    }
  }
}

template struct FocusResponse<float>;
template struct FocusResponse<double>;
template void FocusResponseMaker::make(const SkinModel&, double, double, FocusResponse<float>&);
template void FocusResponseMaker::make(const SkinModel&, double, double, FocusResponse<double>&);

}  // namespace prostm
