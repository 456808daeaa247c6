#include "prostm/acoustics/skin/skin_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "prostm/core/require.hpp"
#include "prostm/core/units.hpp"

namespace prostm {

SkinMotion::SkinMotion(const SkinPatch& patch) : patch_(patch) {
  require_between("rows", patch.rows, 1, 512);
  require_between("cols", patch.cols, 1, 512);
  require_between("cell", patch.cell, 0.1e-3, 20e-3, "m");
}

void SkinMotion::choose_harmonics(double period, int samples, double highest) {
  require_between("period", period, 0.2e-3, 0.25, "s");
  require_between("samples", samples, 3, 4096);
  require_between("highest", highest, 1.0, 10e3, "Hz");
  const int harmonics =
      std::min((samples - 1) / 2, static_cast<int>(highest * period * (1 + 1e-9)));
  if (harmonics < 1) {
    throw std::invalid_argument(
        "highest must be at least 1/period, the frequency of the first harmonic");
  }
  period_ = period;
  samples_ = samples;
  harmonics_ = harmonics;
  displacement_.assign(static_cast<std::size_t>(harmonics) * patch_.size(), 0.0);
  block_.assign(static_cast<std::size_t>(samples) * kBlock, 0.0);
  wave_.clear();
  for (int k = 0; k < samples; ++k) {
    wave_.push_back(std::polar(2.0 / samples, -2.0 * kPi * k / samples));
  }
}

void SkinMotion::load(const PressureLoop& loop) {
  const std::size_t cells = patch_.size();
  if (loop.period != period_ || loop.samples != samples_ ||
      loop.pressure.size() != cells * static_cast<std::size_t>(samples_)) {
    throw std::invalid_argument(
        "the loop must have the period and the samples that prepare() was given, and a pressure "
        "for each sample and cell");
  }
  // direct sums take the same time for any number of samples; an FFT is slow for large prime
  // factors
  for (std::size_t first = 0; first < cells; first += kBlock) {
    const std::size_t count = std::min(kBlock, cells - first);
    for (std::size_t k = 0; k < wave_.size(); ++k) {
      std::copy_n(loop.pressure.begin() + static_cast<std::ptrdiff_t>(k * cells + first), count,
                  block_.begin() + static_cast<std::ptrdiff_t>(k * kBlock));
    }
    fold_block();
    for (int n = 1; n <= harmonics_; ++n) sum_harmonic(n, harmonic(n).subspan(first, count));
  }
}

/// Replaces the samples k and K − k by their sum and their difference: a harmonic's real part needs
/// only the sums, its imaginary part only the differences.
void SkinMotion::fold_block() {
  const std::size_t samples = wave_.size();
  for (std::size_t k = 1; k < samples - k; ++k) {
    double *const early = &block_[k * kBlock], *const late = &block_[(samples - k) * kBlock];
    for (std::size_t c = 0; c < kBlock; ++c) {
      const double sum = early[c] + late[c], difference = early[c] - late[c];
      early[c] = sum;
      late[c] = difference;
    }
  }
}

/// Sums one harmonic over the samples for the cells of `block_`, which is folded.
void SkinMotion::sum_harmonic(int n, std::span<std::complex<double>> out) const {
  std::array<double, kBlock> re{}, im{};
  const std::size_t samples = wave_.size();
  for (std::size_t k = 0; k <= samples / 2; ++k) {
    const std::complex<double> wave = wave_[static_cast<std::size_t>(n) * k % samples];
    const double* const sum = &block_[k * kBlock];
    for (std::size_t c = 0; c < kBlock; ++c) re[c] += wave.real() * sum[c];
    if (k == 0 || 2 * k == samples) continue;  // a sample that is its own partner
    const double* const difference = &block_[(samples - k) * kBlock];
    for (std::size_t c = 0; c < kBlock; ++c) im[c] += wave.imag() * difference[c];
  }
  for (std::size_t c = 0; c < out.size(); ++c) out[c] = {re[c], im[c]};
}

std::span<std::complex<double>> SkinMotion::harmonic(int n) {
  return std::span(displacement_)
      .subspan(static_cast<std::size_t>(n - 1) * patch_.size(), patch_.size());
}

std::span<const std::complex<double>> SkinMotion::displacement(int n) const {
  return std::span(displacement_)
      .subspan(static_cast<std::size_t>(n - 1) * patch_.size(), patch_.size());
}

void rms_velocity(const SkinMotion& motion, std::span<double> out) {
  std::fill(out.begin(), out.end(), 0.0);
  for (int n = 1; n <= motion.harmonics(); ++n) {
    const double omega = 2.0 * kPi * motion.frequency(n);
    const auto field = motion.displacement(n);
    for (std::size_t c = 0; c < out.size(); ++c) {
      out[c] += 0.5 * omega * omega * std::norm(field[c]);
    }
  }
  for (double& value : out) value = std::sqrt(value);
}

void velocity_spectrum(const SkinMotion& motion, int cell, std::span<double> out) {
  for (int n = 1; n <= motion.harmonics(); ++n) {
    out[static_cast<std::size_t>(n - 1)] =
        2.0 * kPi * motion.frequency(n) *
        std::abs(motion.displacement(n)[static_cast<std::size_t>(cell)]);
  }
}

}  // namespace prostm
