#include "prostm/felt/detail/felt_kernels.hpp"

#include <algorithm>
#include <cmath>

namespace prostm {
namespace {

/// The product of a table's values with a spectrum.
void multiply(const std::array<double, kFeltParts>& value, const FeltTurn<double>& by,
              std::array<double, kFeltParts>& out) {
  for (std::size_t i = 0; i < kFeltParts; ++i)
    out[i] = value[i] * by.straight[i] + value[(i + kFeltParts / 2) % kFeltParts] * by.crossed[i];
}

void fill(std::span<const FocusResponse<double>> skins, const FeltAround<double>& around,
          const FeltTurn<double>* turns, FeltPair<double>* pairs, FeltPair<double>* slopes) {
  for (std::size_t s = 0; s < skins.size(); ++s) {
    for (std::size_t j = 0; j < around.sources; ++j) {
      const std::size_t at = s * around.sources + j;
      const auto parts =
          skins[s].at(std::hypot(around.x[j] - around.cell_x, around.y[j] - around.cell_y));
      multiply(parts.value, turns[j], pairs[at].part);
      if (slopes != nullptr) multiply(parts.slope, turns[j], slopes[at].part);
    }
  }
}

void forward(const FeltPair<double>* pairs, std::size_t rows, std::span<const double> amplitude,
             FeltPair<double>* out) {
  for (std::size_t row = 0; row < rows; ++row) {
    out[row].part.fill(0);
    for (const double a : amplitude) {
      for (std::size_t i = 0; i < kFeltParts; ++i) out[row].part[i] += pairs->part[i] * a;
      ++pairs;
    }
  }
}

void backward(const FeltPair<double>* pairs, std::size_t rows, const FeltPair<double>* pull,
              std::span<FeltPair<double>> sums) {
  for (std::size_t row = 0; row < rows; ++row) {
    for (FeltPair<double>& sum : sums) {
      for (std::size_t i = 0; i < kFeltParts; ++i)
        sum.part[i] += pairs->part[i] * pull[row].part[i];
      ++pairs;
    }
  }
}

void slide(const FeltPair<double>* slopes, const FeltPair<double>& pull,
           const FeltAround<double>& around, double* sum_x, double* sum_y) {
  for (std::size_t j = 0; j < around.sources; ++j) {
    double sum = 0;
    for (std::size_t i = 0; i < kFeltParts; ++i) sum += slopes[j].part[i] * pull.part[i];
    const double dx = around.x[j] - around.cell_x, dy = around.y[j] - around.cell_y;
    const double distance = std::max(std::hypot(dx, dy), kLeastDistance);
    sum_x[j] += sum * dx / distance;
    sum_y[j] += sum * dy / distance;
  }
}

void convolve(const double* in, std::size_t step, std::span<const double> taps, std::size_t size,
              double* out) {
  for (std::size_t i = 0; i < size; ++i) {
    out[i] = 0.0;
    for (std::size_t t = 0; t < taps.size(); ++t) out[i] += taps[t] * in[i + t * step];
  }
}

}  // namespace

FeltKernels<double> plain_felt_kernels() {
  return {fill, forward, backward, slide, convolve};
}

}  // namespace prostm
