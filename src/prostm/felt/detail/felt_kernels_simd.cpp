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

// All parts of a pair fit in one to four vectors, which stay in registers in the loop over sources.
HWY_BEFORE_NAMESPACE();
namespace prostm {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, kFeltParts>;
using V = hn::Vec<D>;
using DI = hn::RebindToSigned<D>;
using DS = hn::Rebind<std::int16_t, D>;
using Response = FocusResponse<float>;
using Pair = FeltPair<float>;
using Fixed = FeltFixed;
using Around = FeltAround<float>;

constexpr std::size_t kLanes = hn::MaxLanes(D());
constexpr std::size_t kVectors = kFeltParts / kLanes;
// sources looked up in the table at once; rows of pairs summed at once; vectors convolved at once
constexpr std::size_t kChunk = kFeltParts, kRows = kVectors == 1 ? 4 : 2, kConvolved = 4;
static_assert(kConvolved * kLanes <= kFeltMargin);

HWY_INLINE V Load(const std::array<float, kFeltParts>& parts, std::size_t v) {
  return hn::Load(D(), parts.data() + v * kLanes);
}
HWY_INLINE V Load(const Fixed& pair, std::size_t v) {
  return hn::ConvertTo(D(), hn::PromoteTo(DI(), hn::Load(DS(), pair.part.data() + v * kLanes)));
}

/// Positions of sources in a table: a step, and the share t of it.
struct alignas(64) Places {
  std::array<float, kChunk> step, share;
  std::array<std::size_t, kChunk> low;

  void Find(const Around& around, std::size_t first) {
    const D d;
    const V scale = hn::Set(d, static_cast<float>(1.0 / Response::kStep));
    const V last = hn::Set(d, static_cast<float>(Response::kDistances - 1));
    const V last_step = hn::Sub(last, hn::Set(d, 1.0F));
    for (std::size_t i = 0; i < kChunk; i += kLanes) {
      const V dx = hn::Sub(hn::LoadU(d, around.x + first + i), hn::Set(d, around.cell_x));
      const V dy = hn::Sub(hn::LoadU(d, around.y + first + i), hn::Set(d, around.cell_y));
      const V distance = hn::Sqrt(hn::MulAdd(dx, dx, hn::Mul(dy, dy)));
      const V place = hn::Min(hn::Mul(distance, scale), last);
      const V below = hn::Min(hn::Floor(place), last_step);
      hn::Store(below, d, step.data() + i);
      hn::Store(hn::Sub(place, below), d, share.data() + i);
    }
    for (std::size_t i = 0; i < kChunk; ++i) low[i] = static_cast<std::size_t>(step[i]);
  }
};

/// Returns vector v of a row with real and imaginary parts swapped.
template <std::size_t kCount>
HWY_INLINE V Crossed(const V (&row)[kCount], std::size_t v) {
  if constexpr (kCount == 1) {
    // found by argument-dependent lookup, since not all targets have it
    return ConcatLowerUpper(D(), row[v], row[v]);
  } else {
    return row[(v + kCount / 2) % kCount];
  }
}

/// Writes the product of values of the table and a source's spectrum.
HWY_INLINE void Turn(const V (&value)[kVectors], const FeltTurn<float>& turn, Fixed& out) {
  for (std::size_t v = 0; v < kVectors; ++v) {
    const V product = hn::MulAdd(Crossed(value, v), Load(turn.crossed, v),
                                 hn::Mul(value[v], Load(turn.straight, v)));
    hn::Store(hn::DemoteTo(DS(), hn::NearestInt(product)), DS(), out.part.data() + v * kLanes);
  }
}

/// Fills the pairs, and with kSlopes their slopes, of one cell and skin for at most kChunk sources.
template <bool kSlopes>
HWY_INLINE void FillChunk(const Response& skin, const Places& places, const FeltTurn<float>* turns,
                          std::size_t count, Fixed* pairs, [[maybe_unused]] Fixed* slopes) {
  const D d;
  const V per_step = hn::Set(d, static_cast<float>(1.0 / Response::kStep));
  for (std::size_t i = 0; i < count; ++i) {
    const auto& by = skin.cubic[places.low[i]].by_power;
    const V t = hn::Set(d, places.share[i]);
    V value[kVectors];
    [[maybe_unused]] V slope[kVectors];
    for (std::size_t v = 0; v < kVectors; ++v) {
      // Horner's scheme for a cubic and its derivative
      const V third = Load(by[3], v);
      const V second = hn::MulAdd(t, third, Load(by[2], v));
      const V first = hn::MulAdd(t, second, Load(by[1], v));
      value[v] = hn::MulAdd(t, first, Load(by[0], v));
      if constexpr (kSlopes) {
        const V twice = hn::MulAdd(t, third, second);
        slope[v] = hn::Mul(per_step, hn::MulAdd(t, twice, first));
      }
    }
    Turn(value, turns[i], pairs[i]);
    if constexpr (kSlopes) Turn(slope, turns[i], slopes[i]);
  }
}

void Fill(std::span<const Response> skins, const Around& around, const FeltTurn<float>* turns,
          Fixed* pairs, Fixed* slopes) {
  Places places;
  for (std::size_t first = 0; first < around.sources; first += kChunk) {
    const std::size_t count = std::min(kChunk, around.sources - first);
    places.Find(around, first);
    for (std::size_t s = 0; s < skins.size(); ++s) {
      const std::size_t at = s * around.sources + first;
      if (slopes != nullptr) {
        FillChunk<true>(skins[s], places, turns + first, count, pairs + at, slopes + at);
      } else {
        FillChunk<false>(skins[s], places, turns + first, count, pairs + at, nullptr);
      }
    }
  }
}

/// Sums kCount rows at once: independent sums, which hide the latency of the additions.
template <std::size_t kCount>
HWY_INLINE void SumRows(const Fixed* pairs, std::span<const float> amplitude, Pair* out) {
  const D d;
  V sum[kCount][kVectors];
  for (std::size_t r = 0; r < kCount; ++r) {
    for (std::size_t v = 0; v < kVectors; ++v) sum[r][v] = hn::Zero(d);
  }
  for (std::size_t j = 0; j < amplitude.size(); ++j) {
    const V by = hn::Set(d, amplitude[j]);
    for (std::size_t r = 0; r < kCount; ++r) {
      for (std::size_t v = 0; v < kVectors; ++v)
        sum[r][v] = hn::MulAdd(by, Load(pairs[r * amplitude.size() + j], v), sum[r][v]);
    }
  }
  for (std::size_t r = 0; r < kCount; ++r) {
    for (std::size_t v = 0; v < kVectors; ++v)
      hn::Store(sum[r][v], d, out[r].part.data() + v * kLanes);
  }
}

/// Adds kCount rows at once: each sum is loaded and stored once for all of them.
template <std::size_t kCount>
HWY_INLINE void AddRows(const Fixed* pairs, const Pair* pull, std::span<Pair> sums) {
  const D d;
  V by[kCount][kVectors];
  for (std::size_t r = 0; r < kCount; ++r) {
    for (std::size_t v = 0; v < kVectors; ++v) by[r][v] = Load(pull[r].part, v);
  }
  for (std::size_t j = 0; j < sums.size(); ++j) {
    for (std::size_t v = 0; v < kVectors; ++v) {
      V sum = Load(sums[j].part, v);
      for (std::size_t r = 0; r < kCount; ++r)
        sum = hn::MulAdd(by[r][v], Load(pairs[r * sums.size() + j], v), sum);
      hn::Store(sum, d, sums[j].part.data() + v * kLanes);
    }
  }
}

void Forward(const Fixed* pairs, std::size_t rows, std::span<const float> amplitude, Pair* out) {
  const std::size_t sources = amplitude.size();
  std::size_t row = 0;
  for (; row + kRows <= rows; row += kRows)
    SumRows<kRows>(pairs + row * sources, amplitude, out + row);
  for (; row < rows; ++row) SumRows<1>(pairs + row * sources, amplitude, out + row);
}

void Backward(const Fixed* pairs, std::size_t rows, const Pair* pull, std::span<Pair> sums) {
  std::size_t row = 0;
  for (; row + kRows <= rows; row += kRows)
    AddRows<kRows>(pairs + row * sums.size(), pull + row, sums);
  for (; row < rows; ++row) AddRows<1>(pairs + row * sums.size(), pull + row, sums);
}

void Slide(const Fixed* slopes, const Pair& pull, const Around& around, float* sum_x,
           float* sum_y) {
  const D d;
  V by[kVectors];
  for (std::size_t v = 0; v < kVectors; ++v) by[v] = Load(pull.part, v);
  for (std::size_t first = 0; first < around.sources; first += kLanes) {
    alignas(64) std::array<float, kLanes> each = {};
    for (std::size_t i = 0; i < std::min(kLanes, around.sources - first); ++i) {
      V sum = hn::Mul(Load(slopes[first + i], 0), by[0]);
      for (std::size_t v = 1; v < kVectors; ++v)
        sum = hn::MulAdd(Load(slopes[first + i], v), by[v], sum);
      each[i] = hn::GetLane(hn::SumOfLanes(d, sum));
    }
    const V dx = hn::Sub(hn::LoadU(d, around.x + first), hn::Set(d, around.cell_x));
    const V dy = hn::Sub(hn::LoadU(d, around.y + first), hn::Set(d, around.cell_y));
    const V distance = hn::Max(hn::Sqrt(hn::MulAdd(dx, dx, hn::Mul(dy, dy))),
                               hn::Set(d, static_cast<float>(kLeastDistance)));
    const V slope = hn::Div(hn::Load(d, each.data()), distance);
    hn::StoreU(hn::MulAdd(slope, dx, hn::LoadU(d, sum_x + first)), d, sum_x + first);
    hn::StoreU(hn::MulAdd(slope, dy, hn::LoadU(d, sum_y + first)), d, sum_y + first);
  }
}

void Convolve(const float* in, std::size_t step, std::span<const float> taps, std::size_t size,
              float* out) {
  const D d;
  // independent sums hide the latency of the additions
  for (std::size_t i = 0; i < size; i += kConvolved * kLanes) {
    V sum[kConvolved];
    for (V& s : sum) s = hn::Zero(d);
    for (std::size_t t = 0; t < taps.size(); ++t) {
      const V tap = hn::Set(d, taps[t]);
      for (std::size_t v = 0; v < kConvolved; ++v)
        sum[v] = hn::MulAdd(tap, hn::LoadU(d, in + i + t * step + v * kLanes), sum[v]);
    }
    for (std::size_t v = 0; v < kConvolved; ++v) hn::StoreU(sum[v], d, out + i + v * kLanes);
  }
}

FeltKernels<float> Kernels() {
  return {Fill, Forward, Backward, Slide, Convolve};
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
