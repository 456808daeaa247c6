#include "prostm/experiments/wake.hpp"

#include <cmath>
#include <stdexcept>

#include "prostm/core/require.hpp"
#include "prostm/core/units.hpp"

namespace prostm {
namespace {

using Complex = std::complex<double>;

constexpr double kMargin = 0.6;  // margin between a patch and its copies [m]

/// Returns the m-th wave number of a transform of length n.
double wave_number(int m, int n, double cell) {
  return 2.0 * kPi * (2 * m < n ? m : m - n) / (n * cell);
}

void check(const SkinModel& model, const SkinPatch& patch, std::size_t values, double speed) {
  require_between("rows", patch.rows, 1, 1024);
  require_between("cols", patch.cols, 1, 1024);
  require_between("cell", patch.cell, 0.1e-3, 20e-3, "m");
  require_between("speed", speed, 0.01, 100.0, "m/s");
  if (model.relaxation_time() == 0.0) {
    throw std::invalid_argument("the skin must have a loss, or its wakes never decay");
  }
  if (values != static_cast<std::size_t>(patch.rows * patch.cols)) {
    throw std::invalid_argument("there must be a pressure for each cell of the patch");
  }
}

}  // namespace

std::vector<double> wake_velocity(const SkinModel& model, const SkinPatch& patch,
                                  std::span<const double> pressure, double speed) {
  check(model, patch, pressure.size(), speed);
  const int margin = static_cast<int>(std::ceil(kMargin / patch.cell));
  Fft2 fft(fast_length(patch.rows + margin), fast_length(patch.cols + margin));
  std::vector<Complex> field(static_cast<std::size_t>(fft.rows() * fft.cols()));
  for (int j = 0; j < patch.rows; ++j) {
    for (int i = 0; i < patch.cols; ++i) {
      field[static_cast<std::size_t>(j * fft.cols() + i)] =
          pressure[static_cast<std::size_t>(j * patch.cols + i)];
    }
  }
  fft.forward(field, patch.rows);
  for (int j = 0; j < fft.rows(); ++j) {
    const double ky = wave_number(j, fft.rows(), patch.cell);
    for (int i = 0; i < fft.cols(); ++i) {
      // at a fixed place a passing pattern has ω = −k_x v; T(−ω) is the conjugate of T(ω)
      const double kx = wave_number(i, fft.cols(), patch.cell);
      const double k = std::hypot(kx, ky), omega = -kx * speed;
      Complex& value = field[static_cast<std::size_t>(j * fft.cols() + i)];
      if (k == 0.0) {
        value = 0.0;
        continue;
      }
      const Complex compliance = model.compliance(k, std::abs(omega));
      value *= Complex(0.0, omega) * (omega < 0.0 ? std::conj(compliance) : compliance);
    }
  }
  fft.inverse(field, patch.rows);
  std::vector<double> velocity;
  velocity.reserve(pressure.size());
  for (int j = 0; j < patch.rows; ++j) {
    for (int i = 0; i < patch.cols; ++i) {
      velocity.push_back(field[static_cast<std::size_t>(j * fft.cols() + i)].real());
    }
  }
  return velocity;
}

}  // namespace prostm
