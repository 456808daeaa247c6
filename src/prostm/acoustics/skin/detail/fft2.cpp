#include "prostm/acoustics/skin/detail/fft2.hpp"

#include <algorithm>

namespace prostm {

int fast_length(int least) {
  for (int n = least;; ++n) {
    int rest = n;
    for (const int factor : {2, 3, 5}) {
      while (rest % factor == 0) rest /= factor;
    }
    if (rest == 1) return n;
  }
}

Fft2::Fft2(int rows, int cols)
    : rows_(rows),
      cols_(cols),
      in_(static_cast<std::size_t>(std::max(rows, cols))),
      out_(in_.size()) {
  // the library builds its tables at the first call for each length
  for (const int length : {rows, cols}) {
    transform<true>(in_.data(), length);
    transform<false>(in_.data(), length);
  }
}

template <bool kForward>
void Fft2::transform(const std::complex<double>* line, int length) {
  // a single value is its own transform; the library does not support this length
  if (length == 1) {
    out_[0] = line[0];
  } else if constexpr (kForward) {
    fft_.fwd(out_.data(), line, length);
  } else {
    fft_.inv(out_.data(), line, length);
  }
}

template <bool kForward>
void Fft2::along_columns(std::span<std::complex<double>> raster) {
  const auto stride = static_cast<std::size_t>(cols_);
  const auto height = static_cast<std::size_t>(rows_);
  for (std::size_t i = 0; i < stride; ++i) {
    for (std::size_t j = 0; j < height; ++j) in_[j] = raster[j * stride + i];
    transform<kForward>(in_.data(), rows_);
    for (std::size_t j = 0; j < height; ++j) raster[j * stride + i] = out_[j];
  }
}

void Fft2::forward(std::span<std::complex<double>> raster, int filled) {
  for (int j = 0; j < rows_; ++j) {
    const auto row =
        raster.subspan(static_cast<std::size_t>(j * cols_), static_cast<std::size_t>(cols_));
    if (j >= filled) {
      std::fill(row.begin(), row.end(), 0.0);
      continue;
    }
    transform<true>(row.data(), cols_);
    std::copy_n(out_.begin(), cols_, row.begin());
  }
  along_columns<true>(raster);
}

void Fft2::inverse(std::span<std::complex<double>> raster, int wanted) {
  along_columns<false>(raster);
  for (int j = 0; j < wanted; ++j) {
    const auto row =
        raster.subspan(static_cast<std::size_t>(j * cols_), static_cast<std::size_t>(cols_));
    transform<false>(row.data(), cols_);
    std::copy_n(out_.begin(), cols_, row.begin());
  }
}

}  // namespace prostm
