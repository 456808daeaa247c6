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
void forward(const FeltPair<Real>* pairs, std::size_t rows, std::span<const Real> amplitude,
             FeltPair<Real>* out) {
  for (std::size_t row = 0; row < rows; ++row) {
    out[row].part.fill(0);
    for (const Real a : amplitude) {
      for (std::size_t i = 0; i < kFeltParts; ++i) out[row].part[i] += pairs->part[i] * a;
      ++pairs;
    }
  }
}

template <class Real>
void backward(const FeltPair<Real>* pairs, std::size_t rows, const FeltPair<Real>* pull,
              std::span<FeltPair<Real>> sums) {
  for (std::size_t row = 0; row < rows; ++row) {
    for (FeltPair<Real>& sum : sums) {
      for (std::size_t i = 0; i < kFeltParts; ++i)
        sum.part[i] += pairs->part[i] * pull[row].part[i];
      ++pairs;
    }
  }
}

template <class Real>
void slide(const FeltPair<Real>* slopes, const FeltPair<Real>& pull, std::span<Real> out) {
  for (Real& sum : out) {
    sum = 0;
    for (std::size_t i = 0; i < kFeltParts; ++i) sum += slopes->part[i] * pull.part[i];
    ++slopes;
  }
}

}  // namespace

template <class Real>
FeltKernels<Real> plain_felt_kernels() {
  return {fill<Real>, forward<Real>, backward<Real>, slide<Real>};
}
template FeltKernels<double> plain_felt_kernels();

}  // namespace prostm
