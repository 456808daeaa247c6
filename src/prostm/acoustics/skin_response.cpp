#include "prostm/acoustics/skin_response.hpp"

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

}  // namespace

SkinResponse::SkinResponse(const SkinModel& model, const SkinPatch& patch, SkinPart part)
    : SkinMotion(patch),
      model_(model),
      part_(part),
      fft_(fast_length(2 * patch.rows - 1), fast_length(2 * patch.cols - 1)) {
  if (model.relaxation_time() == 0.0) {
    throw std::invalid_argument("the skin must have a loss, or it never comes to a steady state");
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
  const auto count = static_cast<Eigen::Index>(std::ceil(kPi / patch().cell / kWaveNumberStep));
  bessel_.resize(static_cast<Eigen::Index>(index.size()), count);
  for (const auto& [square, row] : index) {
    const double radius = patch().cell * std::sqrt(square);
    // POSIX's j0: std::cyl_bessel_j raises floating-point exceptions, which tests trap
    for (Eigen::Index m = 0; m < count; ++m) {
      bessel_(row, m) = j0(kWaveNumberStep * static_cast<double>(m + 1) * radius);
    }
  }
}

void SkinResponse::make_kernel(double omega, std::span<Complex> kernel) {
  // (S11), the trapezoidal rule from k = 0, where the integrand is 0
  const Eigen::Index count = bessel_.cols();
  Eigen::VectorXd real(count), imaginary(count);
  const double cell = patch().cell;
  for (Eigen::Index m = 0; m < count; ++m) {
    const double k = kWaveNumberStep * static_cast<double>(m + 1);
    Complex compliance = model_.compliance(k, omega);
    if (part_ == SkinPart::Near) compliance -= model_.wave_compliance(k, omega);
    const Complex value = compliance * k * kWaveNumberStep * cell * cell / (2.0 * kPi);
    real[m] = value.real();
    imaginary[m] = value.imag();
  }
  const Eigen::VectorXd g = bessel_ * real, h = bessel_ * imaginary;
  for (std::size_t c = 0; c < kernel.size(); ++c) {
    kernel[c] = Complex(g[radius_of_[c]], h[radius_of_[c]]);
  }
  fft_.forward(kernel, fft_.rows());
}

void SkinResponse::prepare(double period, int samples, double highest) {
  choose_harmonics(period, samples, highest);
  const auto count = static_cast<std::size_t>(harmonics());
  kernels_.resize(count * padded_.size());
  for (std::size_t n = 0; n < count; ++n) {
    make_kernel(2.0 * kPi * static_cast<double>(n + 1) / period,
                std::span(kernels_).subspan(n * padded_.size(), padded_.size()));
  }
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
