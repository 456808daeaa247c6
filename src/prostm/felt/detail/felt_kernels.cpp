#include "prostm/felt/detail/felt_kernels.hpp"

#include <cmath>

namespace prostm {
namespace {

/// The product of a table's values with a spectrum.
template <class Real>
void multiply(const std::array<Real, kFeltParts>& value, const FeltTurn<Real>& by,
              std::array<Real, kFeltParts>& out) {
  for (std::size_t i = 0; i < kFeltParts; ++i)
    out[i] = value[i] * by.straight[i] + value[(i + kFeltParts / 2) % kFeltParts] * by.crossed[i];
}

template <class Real>
void fill(std::span<const FocusResponse<Real>> skins, Real x, Real y,
          std::span<const FeltSource<Real>> sources, const FeltTurn<Real>* turns,
          FeltPair<Real>* pairs, FeltPair<Real>* slopes) {
  for (std::size_t s = 0; s < skins.size(); ++s) {
    for (std::size_t j = 0; j < sources.size(); ++j) {
      const auto row = skins[s].at(std::hypot(x - sources[j].x, y - sources[j].y));
      multiply(row.value, turns[j], pairs[s * sources.size() + j].part);
      if (slopes != nullptr) multiply(row.slope, turns[j], slopes[s * sources.size() + j].part);
    }
  }
}

template <class Real>
void forward(const FeltPair<Real>* pairs, std::size_t rows, std::size_t sources,
             const Real* amplitude, FeltPair<Real>* out) {
  for (std::size_t row = 0; row < rows; ++row) {
    out[row].part.fill(0);
    for (std::size_t j = 0; j < sources; ++j) {
      for (std::size_t i = 0; i < kFeltParts; ++i)
        out[row].part[i] += pairs[row * sources + j].part[i] * amplitude[j];
    }
  }
}

template <class Real>
void backward(const FeltPair<Real>* pairs, std::size_t rows, std::size_t sources,
              const FeltPair<Real>* pull, FeltPair<Real>* sum) {
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t j = 0; j < sources; ++j) {
      for (std::size_t i = 0; i < kFeltParts; ++i)
        sum[j].part[i] += pairs[row * sources + j].part[i] * pull[row].part[i];
    }
  }
}

template <class Real>
void slide(const FeltPair<Real>* slopes, std::size_t sources, const FeltPair<Real>& pull,
           Real* out) {
  for (std::size_t j = 0; j < sources; ++j) {
    out[j] = 0;
    for (std::size_t i = 0; i < kFeltParts; ++i) out[j] += slopes[j].part[i] * pull.part[i];
  }
}

}  // namespace

template <class Real>
FeltKernels<Real> plain_felt_kernels() {
  return {fill<Real>, forward<Real>, backward<Real>, slide<Real>};
}
template FeltKernels<float> plain_felt_kernels();
template FeltKernels<double> plain_felt_kernels();

}  // namespace prostm
