#include "prostm/acoustics/skin/skin_response.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "prostm/core/require.hpp"
#include "prostm/core/units.hpp"

namespace prostm {
namespace {

using Complex = std::complex<double>;

// step of the integral over wave numbers [rad/m]: a fraction of the pole's width due to the loss
constexpr double kWaveNumberStep = 1.0;
// table entries per cell edge. The integrals have no wave number above π/cell, so the interpolation
// error is below (π/kPerCell)^12 (1·3·…·11/64)²/12! = 8e-10 of the highest wave number's part.
constexpr int kPerCell = 8;

}  // namespace

/// Lagrange's weights for a radius between entries of the table. The Green's functions are even, so
/// radii below 0 are mirrored.
SkinResponse::RadiusPlace SkinResponse::place_of(double radius) {
  RadiusPlace place;
  place.first = static_cast<int>(radius) - kTaps / 2 + 1;
  for (int i = 0; i < kTaps; ++i) {
    double weight = 1.0;
    for (int j = 0; j < kTaps; ++j) {
      if (j != i) weight *= (radius - (place.first + j)) / (i - j);
    }
    place.weight[static_cast<std::size_t>(i)] = weight;
  }
  return place;
}

SkinResponse::SkinResponse(const SkinModel& model, const SkinPatch& patch, SkinPart part)
    : SkinMotion(patch),
      model_(model),
      part_(part),
      fft_(fast_length(2 * patch.rows - 1), fast_length(2 * patch.cols - 1)) {
  if (model.relaxation_time() == 0.0) {
    throw std::invalid_argument("the skin must have a loss, or it never reaches a steady state");
  }
  padded_.resize(static_cast<std::size_t>(fft_.rows() * fft_.cols()));
  make_radii();
}

void SkinResponse::make_radii() {
  // cyclic distances in the padded raster; in cells, their squares are integers
  const auto squared = [](int i, int n) { return std::min(i, n - i) * std::min(i, n - i); };
  std::map<int, int> index;
  radius_of_.reserve(padded_.size());
  for (int j = 0; j < fft_.rows(); ++j) {
    for (int i = 0; i < fft_.cols(); ++i) {
      const int square = squared(j, fft_.rows()) + squared(i, fft_.cols());
      const auto found = index.try_emplace(square, static_cast<int>(index.size()));
      radius_of_.push_back(found.first->second);
    }
  }
  places_.resize(index.size());
  int last = 0;
  for (const auto& [square, i] : index) {
    places_[static_cast<std::size_t>(i)] = place_of(kPerCell * std::sqrt(square));
    last = std::max(last, places_[static_cast<std::size_t>(i)].first + kTaps - 1);
  }
  const auto count = static_cast<Eigen::Index>(std::ceil(kPi / patch().cell / kWaveNumberStep));
  bessel_.resize(last + 1, count);
  for (Eigen::Index m = 0; m < count; ++m) {
    // POSIX's j0: std::cyl_bessel_j raises floating-point exceptions, which tests trap
    const double k = kWaveNumberStep * static_cast<double>(m + 1);
    for (Eigen::Index i = 0; i <= last; ++i) {
      bessel_(i, m) = j0(k * patch().cell / kPerCell * static_cast<double>(i));
    }
  }
}

/// The integrand of (S11) by wave number, without J_0. The trapezoidal rule begins at k = 0, where
/// the integrand is 0.
Complex SkinResponse::integrand(double k, double omega) const {
  Complex compliance = model_.compliance(k, omega);
  if (part_ == SkinPart::Near) compliance -= model_.wave_compliance(k, omega);
  return compliance * k * kWaveNumberStep * patch().cell * patch().cell / (2.0 * kPi);
}

/// (S11) for all harmonics in one product, which reads the large matrix once.
void SkinResponse::make_kernels(double period) {
  const Eigen::Index wave_numbers = bessel_.cols();
  Eigen::MatrixXd integrands(wave_numbers, 2 * harmonics());  // real, imaginary of each harmonic
  for (int n = 0; n < harmonics(); ++n) {
    const double omega = 2.0 * kPi * (n + 1) / period;
    for (Eigen::Index m = 0; m < wave_numbers; ++m) {
      const Complex value = integrand(kWaveNumberStep * static_cast<double>(m + 1), omega);
      integrands(m, 2 * n) = value.real();
      integrands(m, 2 * n + 1) = value.imag();
    }
  }
  const Eigen::MatrixXd table = bessel_ * integrands;
  Eigen::MatrixXd green(static_cast<Eigen::Index>(places_.size()), table.cols());
  for (std::size_t i = 0; i < places_.size(); ++i) {
    auto row = green.row(static_cast<Eigen::Index>(i));
    row.setZero();
    for (int j = 0; j < kTaps; ++j) {
      row += places_[i].weight[static_cast<std::size_t>(j)] *
             table.row(std::abs(places_[i].first + j));
    }
  }
  for (int n = 0; n < harmonics(); ++n) {
    const std::span kernel =
        std::span(kernels_).subspan(static_cast<std::size_t>(n) * padded_.size(), padded_.size());
    for (std::size_t c = 0; c < kernel.size(); ++c) {
      kernel[c] = Complex(green(radius_of_[c], 2 * n), green(radius_of_[c], 2 * n + 1));
    }
    fft_.forward(kernel, fft_.rows());
  }
}

void SkinResponse::prepare(double period, int samples, double highest) {
  choose_harmonics(period, samples, highest);
  kernels_.resize(static_cast<std::size_t>(harmonics()) * padded_.size());
  make_kernels(period);
}

void SkinResponse::respond(const PressureLoop& loop) {
  load(loop);
  const auto rows = static_cast<std::size_t>(patch().rows);
  const auto cols = static_cast<std::size_t>(patch().cols);
  const auto stride = static_cast<std::size_t>(fft_.cols());
  for (int n = 1; n <= harmonics(); ++n) {
    Complex* field = harmonic(n).data();
    for (std::size_t j = 0; j < rows; ++j) {
      std::copy_n(field + j * cols, cols,
                  padded_.begin() + static_cast<std::ptrdiff_t>(j * stride));
      std::fill_n(padded_.begin() + static_cast<std::ptrdiff_t>(j * stride + cols), stride - cols,
                  0.0);
    }
    fft_.forward(padded_, patch().rows);
    const Complex* kernel = &kernels_[static_cast<std::size_t>(n - 1) * padded_.size()];
    for (std::size_t c = 0; c < padded_.size(); ++c) padded_[c] *= kernel[c];
    fft_.inverse(padded_, patch().rows);
    for (std::size_t j = 0; j < rows; ++j) {
      std::copy_n(padded_.begin() + static_cast<std::ptrdiff_t>(j * stride), cols,
                  field + j * cols);
    }
  }
}

}  // namespace prostm
