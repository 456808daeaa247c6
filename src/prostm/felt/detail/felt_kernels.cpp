#include "prostm/felt/detail/felt_kernels.hpp"

#include <cmath>

namespace prostm {
namespace {

/// The product of a complex value with a spectrum, harmonic by harmonic.
template <class Real>
void multiply(const std::array<Real, kFeltParts>& value, const std::array<Real, kFeltParts>& by,
              std::array<Real, kFeltParts>& out) {
  constexpr std::size_t kImaginary = kFeltParts / 2;
  for (std::size_t n = 0; n < kImaginary; ++n) {
    out[n] = value[n] * by[n] - value[n + kImaginary] * by[n + kImaginary];
    out[n + kImaginary] = value[n] * by[n + kImaginary] + value[n + kImaginary] * by[n];
  }
}

template <class Real>
void fill(const FocusResponse<Real>& response, Real x, Real y, const FeltSource<Real>* sources,
          std::size_t count, FeltPair<Real>* pairs, FeltPair<Real>* slopes) {
  for (std::size_t j = 0; j < count; ++j) {
    const auto row = response.at(std::hypot(x - sources[j].x, y - sources[j].y));
    multiply(row.value, sources[j].spectrum, pairs[j].part);
    if (slopes != nullptr) multiply(row.slope, sources[j].spectrum, slopes[j].part);
  }
}

template <class Real>
void forward(const FeltPair<Real>* pairs, std::size_t cells, std::size_t sources,
             const Real* pressure, FeltPair<Real>* out) {
  for (std::size_t x = 0; x < cells; ++x) {
    out[x].part.fill(0);
    for (std::size_t j = 0; j < sources; ++j) {
      for (std::size_t i = 0; i < kFeltParts; ++i)
        out[x].part[i] += pairs[x * sources + j].part[i] * pressure[j];
    }
  }
}

template <class Real>
void backward(const FeltPair<Real>* pairs, std::size_t cells, std::size_t sources,
              const FeltPair<Real>* pull, FeltPair<Real>* sum) {
  for (std::size_t x = 0; x < cells; ++x) {
    for (std::size_t j = 0; j < sources; ++j) {
      for (std::size_t i = 0; i < kFeltParts; ++i)
        sum[j].part[i] += pairs[x * sources + j].part[i] * pull[x].part[i];
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
