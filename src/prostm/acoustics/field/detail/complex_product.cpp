#include "prostm/acoustics/field/detail/complex_product.hpp"

namespace prostm {

PackedMatrix::PackedMatrix(std::size_t rows, std::size_t cols)
    : rows_(rows), cols_((cols + kPanel - 1) / kPanel * kPanel), data_(2 * rows_ * cols_) {}

void complex_product_plain(const PlanarRows& x, const PackedMatrix& y, std::size_t first_panel,
                           float* z_re, float* z_im) {
  constexpr std::size_t kPanel = PackedMatrix::kPanel;
  for (std::size_t m = 0; m < x.rows; ++m) {
    for (std::size_t col = first_panel * kPanel; col < y.cols(); ++col) {
      const float* column = y.panel(col / kPanel) + col % kPanel;
      std::complex<double> sum = 0.0;
      for (std::size_t k = 0; k < y.rows(); ++k) {
        const float* element = column + k * 2 * kPanel;
        const std::complex<float> a(x.re[m * x.stride + k], x.im[m * x.stride + k]),
            b(element[0], element[kPanel]);
        sum += std::complex<double>(a) * std::complex<double>(b);
      }
      z_re[m * y.cols() + col] = static_cast<float>(sum.real());
      z_im[m * y.cols() + col] = static_cast<float>(sum.imag());
    }
  }
}

}  // namespace prostm
