#pragma once
/// Complex matrices in the layout of the vector kernels.

#include <complex>
#include <cstddef>
#include <vector>

namespace prostm {

/// Rows of complex numbers in single precision, with separate real and imaginary parts. Each row is
/// padded with zeros to whole blocks of kBlock floats and aligned to a block.
class ComplexRows {
 public:
  static constexpr std::size_t kBlock = 16;

  ComplexRows() = default;
  ComplexRows(std::size_t rows, std::size_t columns)
      : blocks_((columns + kBlock - 1) / kBlock), columns_(columns), values_(2 * rows * blocks_) {}

  std::size_t columns() const { return columns_; }
  std::size_t stride() const { return blocks_ * kBlock; }  ///< floats from one row to the next

  float* re(std::size_t row) { return values_[2 * row * blocks_].v; }
  float* im(std::size_t row) { return values_[(2 * row + 1) * blocks_].v; }
  const float* re(std::size_t row) const { return values_[2 * row * blocks_].v; }
  const float* im(std::size_t row) const { return values_[(2 * row + 1) * blocks_].v; }

  std::complex<float> at(std::size_t row, std::size_t column) const {
    return {re(row)[column], im(row)[column]};
  }
  void set(std::size_t row, std::size_t column, std::complex<float> value) {
    re(row)[column] = value.real();
    im(row)[column] = value.imag();
  }

 private:
  struct alignas(64) Block {
    float v[kBlock] = {};
  };
  std::size_t blocks_ = 0, columns_ = 0;
  std::vector<Block> values_;
};

}  // namespace prostm
