#pragma once
/// Fourier transforms of rasters.

#include <complex>
#include <span>
#include <unsupported/Eigen/FFT>
#include <vector>

namespace prostm {

/// Returns the smallest n ≥ `least` without a prime factor above 5, for which the FFT is fast. @pre
/// least ≥ 1
int fast_length(int least);

/// Transforms a raster of rows × cols complex values, row-major, in place. Allocates only in its
/// constructor.
class Fft2 {
 public:
  /// @pre rows, cols ≥ 1
  Fft2(int rows, int cols);

  int rows() const { return rows_; }
  int cols() const { return cols_; }
  /// X_uv = Σ_jm x_jm e^{−2πi(uj/rows + vm/cols)}. Rows from `filled` on are taken as 0.
  void forward(std::span<std::complex<double>> raster, int filled);
  /// The inverse, 1/(rows·cols) included; rows from `wanted` on are left undefined.
  void inverse(std::span<std::complex<double>> raster, int wanted);

 private:
  /// Transforms a line of `length` values into out_.
  template <bool kForward>
  void transform(const std::complex<double>* line, int length);
  template <bool kForward>
  void along_columns(std::span<std::complex<double>> raster);

  int rows_, cols_;
  Eigen::FFT<double> fft_;
  std::vector<std::complex<double>> in_, out_;  // one line each
};

}  // namespace prostm
