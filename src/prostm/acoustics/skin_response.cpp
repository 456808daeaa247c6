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

const SkinPatch& checked(const SkinPatch& patch) {
  require_between("rows", patch.rows, 1, 512);
  require_between("cols", patch.cols, 1, 512);
  require_between("cell", patch.cell, 0.1e-3, 20e-3, "m");
  return patch;
}

}  // namespace

SkinResponse::SkinResponse(const SkinModel& model, const SkinPatch& patch)
    : model_(model),
      patch_(checked(patch)),
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
  const auto count = static_cast<Eigen::Index>(std::ceil(kPi / patch_.cell / kWaveNumberStep));
  bessel_.resize(static_cast<Eigen::Index>(index.size()), count);
  for (const auto& [square, row] : index) {
    const double radius = patch_.cell * std::sqrt(square);
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
  for (Eigen::Index m = 0; m < count; ++m) {
    const double k = kWaveNumberStep * static_cast<double>(m + 1);
    const Complex value =
        model_.compliance(k, omega) * k * kWaveNumberStep * patch_.cell * patch_.cell / (2.0 * kPi);
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
  require_between("period", period, 0.2e-3, 0.25, "s");
  require_between("samples", samples, 3, 4096);
  require_between("highest", highest, 1.0, 10e3, "Hz");
  const int harmonics =
      std::min((samples - 1) / 2, static_cast<int>(highest * period * (1 + 1e-9)));
  if (harmonics < 1) {
    throw std::invalid_argument(
        "highest must be at least 1/period, or there is no harmonic to respond with");
  }
  period_ = period;
  samples_ = samples;
  harmonics_ = harmonics;
  const auto count = static_cast<std::size_t>(harmonics);
  kernels_.resize(count * padded_.size());
  for (std::size_t n = 0; n < count; ++n) {
    make_kernel(2.0 * kPi * static_cast<double>(n + 1) / period,
                std::span(kernels_).subspan(n * padded_.size(), padded_.size()));
  }
  displacement_.assign(count * static_cast<std::size_t>(patch_.rows * patch_.cols), 0.0);
  course_.resize(static_cast<std::size_t>(samples));
  spectrum_.resize(course_.size());
  // the library makes its tables at the first call for this length
  time_fft_.fwd(spectrum_.data(), course_.data(), samples);
}

void SkinResponse::transform_in_time(const PressureLoop& loop) {
  const auto cells = static_cast<std::size_t>(patch_.rows * patch_.cols);
  for (std::size_t c = 0; c < cells; ++c) {
    for (std::size_t k = 0; k < course_.size(); ++k) course_[k] = loop.pressure[k * cells + c];
    time_fft_.fwd(spectrum_.data(), course_.data(), samples_);
    for (int n = 1; n <= harmonics_; ++n) {
      displacement_[static_cast<std::size_t>(n - 1) * cells + c] =
          2.0 / samples_ * spectrum_[static_cast<std::size_t>(n)];
    }
  }
}

void SkinResponse::respond(const PressureLoop& loop) {
  const auto cells = static_cast<std::size_t>(patch_.rows * patch_.cols);
  if (loop.period != period_ || loop.samples != samples_ ||
      loop.pressure.size() != cells * static_cast<std::size_t>(samples_)) {
    throw std::invalid_argument(
        "the loop must have the period and the samples that prepare() was given, and a pressure "
        "for each sample and cell");
  }
  transform_in_time(loop);
  const auto rows = static_cast<std::size_t>(patch_.rows);
  const auto cols = static_cast<std::size_t>(patch_.cols);
  const auto stride = static_cast<std::size_t>(fft_.cols());
  for (std::size_t n = 0; n < static_cast<std::size_t>(harmonics_); ++n) {
    Complex* field = &displacement_[n * cells];
    for (std::size_t j = 0; j < rows; ++j) {
      std::copy_n(field + j * cols, cols,
                  padded_.begin() + static_cast<std::ptrdiff_t>(j * stride));
      std::fill_n(padded_.begin() + static_cast<std::ptrdiff_t>(j * stride + cols), stride - cols,
                  0.0);
    }
    fft_.forward(padded_, patch_.rows);
    const Complex* kernel = &kernels_[n * padded_.size()];
    for (std::size_t c = 0; c < padded_.size(); ++c) padded_[c] *= kernel[c];
    fft_.inverse(padded_, patch_.rows);
    for (std::size_t j = 0; j < rows; ++j) {
      std::copy_n(padded_.begin() + static_cast<std::ptrdiff_t>(j * stride), cols,
                  field + j * cols);
    }
  }
}

std::span<const Complex> SkinResponse::displacement(int n) const {
  const auto cells = static_cast<std::size_t>(patch_.rows * patch_.cols);
  return std::span(displacement_).subspan(static_cast<std::size_t>(n - 1) * cells, cells);
}

void rms_velocity(const SkinResponse& response, std::span<double> out) {
  std::fill(out.begin(), out.end(), 0.0);
  for (int n = 1; n <= response.harmonics(); ++n) {
    const double omega = 2.0 * kPi * response.frequency(n);
    const auto field = response.displacement(n);
    for (std::size_t c = 0; c < out.size(); ++c) {
      out[c] += 0.5 * omega * omega * std::norm(field[c]);
    }
  }
  for (double& value : out) value = std::sqrt(value);
}

void velocity_spectrum(const SkinResponse& response, int cell, std::span<double> out) {
  for (int n = 1; n <= response.harmonics(); ++n) {
    out[static_cast<std::size_t>(n - 1)] =
        2.0 * kPi * response.frequency(n) *
        std::abs(response.displacement(n)[static_cast<std::size_t>(cell)]);
  }
}

}  // namespace prostm
