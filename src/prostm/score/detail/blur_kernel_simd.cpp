#include "prostm/score/detail/blur_kernel.hpp"

// only targets whose vectors have a length known at compile time: the sums are arrays of vectors
#ifndef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#endif
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prostm/score/detail/blur_kernel_simd.cpp"
#include <hwy/foreach_target.h>
// after the line above, which includes this file once for each target
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace prostm {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<double, kStripWidth>;

constexpr std::size_t kLanes = hn::MaxLanes(D());
// vectors of a row processed at once: processors with wide vectors have enough registers for two
constexpr std::size_t kVectors = kLanes >= 8 && 2 * kLanes <= kStripWidth ? 2 : 1;

void StripSums(const double* taps, const double* from, std::size_t count, double* to) {
  const D d;
  for (std::size_t i = 0; i < kStripWidth; i += kVectors * kLanes) {
    hn::Vec<D> sum[kSumsAtOnce][kVectors];
    for (auto& row : sum)
      for (auto& s : row) s = hn::Zero(d);
    for (std::size_t k = 0; k < count; ++k) {
      hn::Vec<D> value[kVectors];
      for (std::size_t v = 0; v < kVectors; ++v)
        value[v] = hn::LoadU(d, from + k * kStripWidth + i + v * kLanes);
      for (std::size_t j = 0; j < kSumsAtOnce; ++j) {
        const auto tap =
            hn::Set(d, taps[static_cast<std::ptrdiff_t>(k) - static_cast<std::ptrdiff_t>(j)]);
        for (std::size_t v = 0; v < kVectors; ++v) sum[j][v] = hn::MulAdd(tap, value[v], sum[j][v]);
      }
    }
    for (std::size_t j = 0; j < kSumsAtOnce; ++j) {
      for (std::size_t v = 0; v < kVectors; ++v)
        hn::StoreU(sum[j][v], d, to + j * kStripWidth + i + v * kLanes);
    }
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace prostm
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace prostm {
HWY_EXPORT(StripSums);

void strip_sums(const double* taps, const double* from, std::size_t count, double* to) {
  HWY_DYNAMIC_DISPATCH(StripSums)(taps, from, count, to);
}

}  // namespace prostm
#endif
