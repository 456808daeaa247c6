#pragma once
/// Products of complex matrices in single precision, for fields over a whole loop.

#include <complex>
#include <cstddef>
#include <vector>

namespace prostm {

/// The right factor of a product, in panels of kPanel columns, so that the inner loop reads
/// consecutive memory. Padded with columns of zeros to a multiple of kPanel.
class PackedMatrix {
 public:
  static constexpr std::size_t kPanel = 16;

  /// Makes a zero matrix.
  PackedMatrix(std::size_t rows, std::size_t cols);

  std::size_t rows() const { return rows_; }
  /// Number of columns with the padding, a multiple of kPanel.
  std::size_t cols() const { return cols_; }
  void set(std::size_t row, std::size_t col, std::complex<float> value) {
    float* at = data_.data() + (col / kPanel * rows_ + row) * 2 * kPanel + col % kPanel;
    at[0] = value.real();
    at[kPanel] = value.imag();
  }
  /// Returns panel `index`: row by row, kPanel real parts followed by kPanel imaginary parts.
  const float* panel(std::size_t index) const { return data_.data() + index * rows_ * 2 * kPanel; }

 private:
  std::size_t rows_, cols_;
  std::vector<float> data_;
};

/// Rows of complex numbers, real and imaginary parts in separate arrays; row m begins at m·stride.
struct PlanarRows {
  const float* re = nullptr;
  const float* im = nullptr;
  std::size_t rows = 0, stride = 0;
};

/// Computes z = x y from column `first_panel`·kPanel on; row m of z begins at m·y.cols(). Allocates
/// nothing.
/// @pre x has y.rows() columns, z_re and z_im hold x.rows·y.cols() floats.
void complex_product(const PlanarRows& x, const PackedMatrix& y, std::size_t first_panel,
                     float* z_re, float* z_im);
/// Reference for complex_product(): term by term, with sums in double precision.
void complex_product_plain(const PlanarRows& x, const PackedMatrix& y, std::size_t first_panel,
                           float* z_re, float* z_im);

/// Σ |z|² over a row. @pre count is a multiple of PackedMatrix::kPanel.
float sum_of_squares(const float* re, const float* im, std::size_t count);
/// out[i] = scale·|z_i|². @pre count is a multiple of PackedMatrix::kPanel.
void squares(const float* re, const float* im, std::size_t count, float scale, float* out);

}  // namespace prostm
