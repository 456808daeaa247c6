#include "prostm/felt/detail/felt_kernels.hpp"

// only targets whose vectors have a length known at compile time: the sums are arrays of vectors
#ifndef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#endif
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prostm/felt/detail/felt_kernels_simd.cpp"
#include <hwy/foreach_target.h>
// after the line above, which includes this file once for each target
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

// All parts of a pair are one to four vectors, and stay in registers while sources go by.
HWY_BEFORE_NAMESPACE();
namespace prostm {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, kFeltParts>;
using V = hn::Vec<D>;
using DH = hn::CappedTag<float, kFeltParts / 2>;
using H = hn::Vec<DH>;
using Pair = FeltPair<float>;
using Source = FeltSource<float>;

constexpr std::size_t kLanes = hn::MaxLanes(D());
constexpr std::size_t kVectors = kFeltParts / kLanes;
constexpr std::size_t kHalf = kFeltParts / 2;
constexpr std::size_t kHalfLanes = hn::MaxLanes(DH());

/// Writes the product of a·values + … of two rows of the table with a source's spectrum.
template <class F>
HWY_INLINE void Blend(const F& blended, const Source& source, Pair& out) {
  const DH d;
  for (std::size_t n = 0; n < kHalf; n += kHalfLanes) {
    const H re = blended(n), im = blended(n + kHalf);
    const H by_re = hn::LoadU(d, source.spectrum.data() + n);
    const H by_im = hn::LoadU(d, source.spectrum.data() + n + kHalf);
    hn::StoreU(hn::NegMulAdd(im, by_im, hn::Mul(re, by_re)), d, out.part.data() + n);
    hn::StoreU(hn::MulAdd(re, by_im, hn::Mul(im, by_re)), d, out.part.data() + n + kHalf);
  }
}

void Fill(const FocusResponse<float>& response, float x, float y, const Source* sources,
          std::size_t count, Pair* pairs, Pair* slopes) {
  const DH d;
  constexpr auto kStep = static_cast<float>(FocusResponse<float>::kStep);
  constexpr auto kLast = static_cast<float>(FocusResponse<float>::kDistances - 1);
  for (std::size_t j = 0; j < count; ++j) {
    const float dx = x - sources[j].x, dy = y - sources[j].y;
    const float place = std::min(std::sqrt(dx * dx + dy * dy) / kStep, kLast);
    const auto low = std::min(static_cast<std::size_t>(place), response.row.size() - 2);
    const auto &a = response.row[low], &b = response.row[low + 1];
    const float t = place - static_cast<float>(low), u = 1.0F - t;
    const auto value = [&](std::size_t n) HWY_ATTR {
      H sum = hn::Mul(hn::Set(d, (1.0F + 2.0F * t) * u * u), hn::Load(d, a.value.data() + n));
      sum = hn::MulAdd(hn::Set(d, t * u * u), hn::Load(d, a.slope.data() + n), sum);
      sum = hn::MulAdd(hn::Set(d, t * t * (3.0F - 2.0F * t)), hn::Load(d, b.value.data() + n), sum);
      return hn::MulAdd(hn::Set(d, -t * t * u), hn::Load(d, b.slope.data() + n), sum);
    };
    Blend(value, sources[j], pairs[j]);
    if (slopes == nullptr) continue;
    const auto slope = [&](std::size_t n) HWY_ATTR {
      const H rise = hn::Sub(hn::Load(d, b.value.data() + n), hn::Load(d, a.value.data() + n));
      H sum = hn::Mul(hn::Set(d, 6.0F * t * u / kStep), rise);
      sum = hn::MulAdd(hn::Set(d, u * (1.0F - 3.0F * t) / kStep), hn::Load(d, a.slope.data() + n),
                       sum);
      return hn::MulAdd(hn::Set(d, t * (3.0F * t - 2.0F) / kStep), hn::Load(d, b.slope.data() + n),
                        sum);
    };
    Blend(slope, sources[j], slopes[j]);
  }
}

void Forward(const Pair* pairs, std::size_t cells, std::size_t sources, const float* pressure,
             Pair* out) {
  const D d;
  for (std::size_t x = 0; x < cells; ++x) {
    const Pair* row = pairs + x * sources;
    // two sums, so that one need not wait for the other
    V even[kVectors], odd[kVectors];
    for (std::size_t v = 0; v < kVectors; ++v) even[v] = odd[v] = hn::Zero(d);
    std::size_t j = 0;
    for (; j + 2 <= sources; j += 2) {
      const V p = hn::Set(d, pressure[j]), q = hn::Set(d, pressure[j + 1]);
      for (std::size_t v = 0; v < kVectors; ++v) {
        even[v] = hn::MulAdd(p, hn::Load(d, row[j].part.data() + v * kLanes), even[v]);
        odd[v] = hn::MulAdd(q, hn::Load(d, row[j + 1].part.data() + v * kLanes), odd[v]);
      }
    }
    for (; j < sources; ++j) {
      const V p = hn::Set(d, pressure[j]);
      for (std::size_t v = 0; v < kVectors; ++v)
        even[v] = hn::MulAdd(p, hn::Load(d, row[j].part.data() + v * kLanes), even[v]);
    }
    for (std::size_t v = 0; v < kVectors; ++v)
      hn::Store(hn::Add(even[v], odd[v]), d, out[x].part.data() + v * kLanes);
  }
}

void Backward(const Pair* pairs, std::size_t cells, std::size_t sources, const Pair* pull,
              Pair* sum) {
  const D d;
  for (std::size_t x = 0; x < cells; ++x) {
    V by[kVectors];
    for (std::size_t v = 0; v < kVectors; ++v)
      by[v] = hn::Load(d, pull[x].part.data() + v * kLanes);
    for (std::size_t j = 0; j < sources; ++j) {
      for (std::size_t v = 0; v < kVectors; ++v) {
        float* to = sum[j].part.data() + v * kLanes;
        const V pair = hn::Load(d, pairs[x * sources + j].part.data() + v * kLanes);
        hn::Store(hn::MulAdd(by[v], pair, hn::Load(d, to)), d, to);
      }
    }
  }
}

void Slide(const Pair* slopes, std::size_t sources, const Pair& pull, float* out) {
  const D d;
  for (std::size_t j = 0; j < sources; ++j) {
    V sum = hn::Zero(d);
    for (std::size_t v = 0; v < kVectors; ++v) {
      sum = hn::MulAdd(hn::Load(d, slopes[j].part.data() + v * kLanes),
                       hn::Load(d, pull.part.data() + v * kLanes), sum);
    }
    out[j] = hn::GetLane(hn::SumOfLanes(d, sum));
  }
}

FeltKernels<float> Kernels() {
  return {Fill, Forward, Backward, Slide};
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace prostm
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace prostm {
HWY_EXPORT(Kernels);

FeltKernels<float> fast_felt_kernels() {
  return HWY_DYNAMIC_DISPATCH(Kernels)();
}

}  // namespace prostm
#endif
