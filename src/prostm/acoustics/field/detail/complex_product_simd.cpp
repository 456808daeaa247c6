#include "prostm/acoustics/field/detail/complex_product.hpp"

// only targets whose vectors have a length known at compile time: the sums are arrays of vectors
#ifndef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#endif
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prostm/acoustics/field/detail/complex_product_simd.cpp"
#include <hwy/foreach_target.h>
// after the line above, which includes this file once for each target
#include <hwy/highway.h>

// A tile of z, a few rows by one or two vectors of columns, stays in registers while it is summed
// over the whole inner dimension; a panel of y stays in the cache for all rows of x.
HWY_BEFORE_NAMESPACE();
namespace prostm {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
constexpr std::size_t kPanel = PackedMatrix::kPanel;
using D = hn::CappedTag<float, kPanel>;
using V = hn::Vec<D>;

constexpr std::size_t kLanes = hn::MaxLanes(D());
constexpr std::size_t kVectors = kLanes == kPanel ? 1 : 2;  // per row of a tile
constexpr std::size_t kTileRows = kVectors == 1 ? 6 : 3;    // most that fit in 32 or 16 registers

template <std::size_t kRows>
HWY_INLINE void tile(const PlanarRows& x, std::size_t first_row, const float* HWY_RESTRICT y,
                     std::size_t inner, float* z_re, float* z_im, std::size_t z_stride) {
  const D d;
  V re[kRows][kVectors], im[kRows][kVectors];
  for (std::size_t r = 0; r < kRows; ++r) {
    for (std::size_t v = 0; v < kVectors; ++v) re[r][v] = im[r][v] = hn::Zero(d);
  }
  const float* x_re = x.re + first_row * x.stride;
  const float* x_im = x.im + first_row * x.stride;
  for (std::size_t k = 0; k < inner; ++k) {
    const float* row = y + k * 2 * kPanel;
    V y_re[kVectors], y_im[kVectors];
    for (std::size_t v = 0; v < kVectors; ++v) {
      y_re[v] = hn::LoadU(d, row + v * kLanes);
      y_im[v] = hn::LoadU(d, row + kPanel + v * kLanes);
    }
    for (std::size_t r = 0; r < kRows; ++r) {
      const V a = hn::Set(d, x_re[r * x.stride + k]), b = hn::Set(d, x_im[r * x.stride + k]);
      for (std::size_t v = 0; v < kVectors; ++v) {
        re[r][v] = hn::NegMulAdd(b, y_im[v], hn::MulAdd(a, y_re[v], re[r][v]));
        im[r][v] = hn::MulAdd(b, y_re[v], hn::MulAdd(a, y_im[v], im[r][v]));
      }
    }
  }
  for (std::size_t r = 0; r < kRows; ++r) {
    for (std::size_t v = 0; v < kVectors; ++v) {
      hn::StoreU(re[r][v], d, z_re + (first_row + r) * z_stride + v * kLanes);
      hn::StoreU(im[r][v], d, z_im + (first_row + r) * z_stride + v * kLanes);
    }
  }
}

void Product(const PlanarRows& x, const PackedMatrix& y, std::size_t first_panel, float* z_re,
             float* z_im) {
  for (std::size_t p = first_panel; p < y.cols() / kPanel; ++p) {
    for (std::size_t c = 0; c < kPanel; c += kVectors * kLanes) {
      const float* columns = y.panel(p) + c;
      float* to_re = z_re + p * kPanel + c;
      float* to_im = z_im + p * kPanel + c;
      std::size_t row = 0;
      for (; row + kTileRows <= x.rows; row += kTileRows) {
        tile<kTileRows>(x, row, columns, y.rows(), to_re, to_im, y.cols());
      }
      for (; row < x.rows; ++row) tile<1>(x, row, columns, y.rows(), to_re, to_im, y.cols());
    }
  }
}

float Sum(const float* re, const float* im, std::size_t count) {
  const D d;
  V sum = hn::Zero(d);
  for (std::size_t i = 0; i < count; i += kLanes) {
    const V a = hn::LoadU(d, re + i), b = hn::LoadU(d, im + i);
    sum = hn::MulAdd(a, a, hn::MulAdd(b, b, sum));
  }
  return hn::GetLane(hn::SumOfLanes(d, sum));
}

void Squares(const float* re, const float* im, std::size_t count, float scale, float* out) {
  const D d;
  for (std::size_t i = 0; i < count; i += kLanes) {
    const V a = hn::LoadU(d, re + i), b = hn::LoadU(d, im + i);
    hn::StoreU(hn::Mul(hn::Set(d, scale), hn::MulAdd(a, a, hn::Mul(b, b))), d, out + i);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace prostm
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace prostm {
namespace {
HWY_EXPORT(Product);
HWY_EXPORT(Sum);
HWY_EXPORT(Squares);
}  // namespace

void complex_product(const PlanarRows& x, const PackedMatrix& y, std::size_t first_panel,
                     float* z_re, float* z_im) {
  HWY_DYNAMIC_DISPATCH(Product)(x, y, first_panel, z_re, z_im);
}

float sum_of_squares(const float* re, const float* im, std::size_t count) {
  return HWY_DYNAMIC_DISPATCH(Sum)(re, im, count);
}

void squares(const float* re, const float* im, std::size_t count, float scale, float* out) {
  HWY_DYNAMIC_DISPATCH(Squares)(re, im, count, scale, out);
}

}  // namespace prostm
#endif  // HWY_ONCE
