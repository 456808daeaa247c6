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
using D = hn::ScalableTag<double>;

constexpr std::size_t kLanes = hn::MaxLanes(D());
constexpr std::size_t kVectors = 8;  // sums side by side, so that none waits for its last addition

template <std::size_t kSums>
HWY_INLINE void SumBlock(std::span<const double> taps, const double* from, std::size_t step,
                         double* to) {
  const D d;
  hn::Vec<D> sum[kSums];
  for (auto& s : sum) s = hn::Zero(d);
  for (const double tap : taps) {
    const auto weight = hn::Set(d, tap);
    for (std::size_t v = 0; v < kSums; ++v)
      sum[v] = hn::MulAdd(weight, hn::LoadU(d, from + v * kLanes), sum[v]);
    from += step;
  }
  for (std::size_t v = 0; v < kSums; ++v) hn::StoreU(sum[v], d, to + v * kLanes);
}

void WeightedSums(std::span<const double> taps, const double* from, std::size_t step,
                  std::size_t count, double* to) {
  std::size_t i = 0;
  for (; i + kVectors * kLanes <= count; i += kVectors * kLanes)
    SumBlock<kVectors>(taps, from + i, step, to + i);
  for (; i + kLanes <= count; i += kLanes) SumBlock<1>(taps, from + i, step, to + i);
  for (; i < count; ++i) {
    double sum = 0.0;
    for (std::size_t t = 0; t < taps.size(); ++t) sum += taps[t] * from[t * step + i];
    to[i] = sum;
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace prostm
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace prostm {
HWY_EXPORT(WeightedSums);

void weighted_sums(std::span<const double> taps, const double* from, std::size_t step,
                   std::size_t count, double* to) {
  HWY_DYNAMIC_DISPATCH(WeightedSums)(taps, from, step, count, to);
}

}  // namespace prostm
#endif
