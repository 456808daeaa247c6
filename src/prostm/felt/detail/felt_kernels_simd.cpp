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
using Source = FeltSource<float>;

constexpr std::size_t kLanes = hn::MaxLanes(D());
constexpr std::size_t kVectors = kFeltParts / kLanes;
// sources looked up in the table at once; rows of pairs summed at once
constexpr std::size_t kChunk = kFeltParts, kRows = kVectors == 1 ? 4 : 2;

HWY_INLINE V Load(const std::array<float, kFeltParts>& parts, std::size_t v) {
  return hn::Load(D(), parts.data() + v * kLanes);
}
HWY_INLINE V Load(const Fixed& pair, std::size_t v) {
  return hn::ConvertTo(D(), hn::PromoteTo(DI(), hn::Load(DS(), pair.part.data() + v * kLanes)));
}

/// Positions of sources in a table: rows low and low + 1, and the weights of their entries for the
/// value and for its slope.
struct alignas(64) Places {
  std::array<float, kChunk> distance;  // first squared, finally the distance of row low
  std::array<std::array<float, kChunk>, 4> value, slope;
  std::array<std::size_t, kChunk> low;

  void Find(float x, float y, const Source* sources, std::size_t count) {
    constexpr auto kPerStep = static_cast<float>(1.0 / Response::kStep);
    constexpr auto kLast = static_cast<float>(Response::kDistances - 1);
    for (std::size_t i = 0; i < count; ++i) {
      const float dx = x - sources[i].x, dy = y - sources[i].y;
      distance[i] = dx * dx + dy * dy;
    }
    const D d;
    const V one = hn::Set(d, 1.0F), scale = hn::Set(d, kPerStep);
    for (std::size_t i = 0; i < kChunk; i += kLanes) {
      const V away = hn::Mul(hn::Sqrt(hn::Load(d, distance.data() + i)), scale);
      const V place = hn::Min(away, hn::Set(d, kLast));
      const V below = hn::Min(hn::Floor(place), hn::Set(d, kLast - 1.0F));
      hn::Store(below, d, distance.data() + i);
      const V t = hn::Sub(place, below), u = hn::Sub(one, t);
      const V tu = hn::Mul(t, u), tt = hn::Mul(t, t);
      const V more = hn::Mul(tt, hn::NegMulAdd(hn::Set(d, 2.0F), t, hn::Set(d, 3.0F)));
      const V rise = hn::Mul(tu, hn::Set(d, 6.0F * kPerStep));
      const V three = hn::Mul(hn::Set(d, 3.0F), t);
      const auto store = [&](V what, std::array<float, kChunk>& to)
                             HWY_ATTR { hn::Store(what, d, to.data() + i); };
      store(hn::Sub(one, more), value[0]);
      store(hn::Mul(tu, u), value[1]);
      store(more, value[2]);
      store(hn::Neg(hn::Mul(tu, t)), value[3]);
      store(hn::Neg(rise), slope[0]);
      store(hn::Mul(scale, hn::Mul(u, hn::Sub(one, three))), slope[1]);
      store(rise, slope[2]);
      store(hn::Mul(scale, hn::Mul(t, hn::Sub(three, hn::Set(d, 2.0F)))), slope[3]);
    }
    for (std::size_t i = 0; i < count; ++i) low[i] = static_cast<std::size_t>(distance[i]);
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

/// Writes the product of a sum of four rows of the table and a source's spectrum.
HWY_INLINE void Blend(const Response& response, std::size_t low,
                      const std::array<std::array<float, kChunk>, 4>& by, std::size_t i,
                      const FeltTurn<float>& turn, Fixed& out) {
  const D d;
  const auto &a = response.row[low], &b = response.row[low + 1];
  V sum[kVectors];
  for (std::size_t v = 0; v < kVectors; ++v) {
    sum[v] = hn::Mul(hn::Set(d, by[0][i]), Load(a.value, v));
    sum[v] = hn::MulAdd(hn::Set(d, by[1][i]), Load(a.slope, v), sum[v]);
    sum[v] = hn::MulAdd(hn::Set(d, by[2][i]), Load(b.value, v), sum[v]);
    sum[v] = hn::MulAdd(hn::Set(d, by[3][i]), Load(b.slope, v), sum[v]);
  }
  for (std::size_t v = 0; v < kVectors; ++v) {
    const V product =
        hn::MulAdd(Crossed(sum, v), Load(turn.crossed, v), hn::Mul(sum[v], Load(turn.straight, v)));
    hn::Store(hn::DemoteTo(DS(), hn::NearestInt(product)), DS(), out.part.data() + v * kLanes);
  }
}

void Fill(std::span<const Response> skins, float x, float y, std::span<const Source> sources,
          const FeltTurn<float>* turns, Fixed* pairs, Fixed* slopes) {
  Places places = {};
  const std::size_t all = sources.size();
  for (std::size_t first = 0; first < all; first += kChunk) {
    const std::size_t count = std::min(kChunk, all - first);
    places.Find(x, y, &sources[first], count);
    for (std::size_t s = 0; s < skins.size(); ++s) {
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t j = first + i, at = s * all + j;
        Blend(skins[s], places.low[i], places.value, i, turns[j], pairs[at]);
        if (slopes != nullptr)
          Blend(skins[s], places.low[i], places.slope, i, turns[j], slopes[at]);
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

void Slide(const Fixed* slopes, const Pair& pull, std::span<float> out) {
  const D d;
  for (std::size_t j = 0; j < out.size(); ++j) {
    V sum = hn::Zero(d);
    for (std::size_t v = 0; v < kVectors; ++v)
      sum = hn::MulAdd(Load(slopes[j], v), Load(pull.part, v), sum);
    out[j] = hn::GetLane(hn::SumOfLanes(d, sum));
  }
}

void Convolve(const float* in, std::size_t step, std::span<const float> taps, std::size_t size,
              float* out) {
  const D d;
  for (std::size_t i = 0; i < size; i += kLanes) {
    V sum = hn::Zero(d);
    for (std::size_t t = 0; t < taps.size(); ++t)
      sum = hn::MulAdd(hn::Set(d, taps[t]), hn::LoadU(d, in + i + t * step), sum);
    hn::StoreU(sum, d, out + i);
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
