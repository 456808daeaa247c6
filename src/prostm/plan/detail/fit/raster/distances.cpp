#include "prostm/plan/detail/fit/raster/distances.hpp"

#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prostm/plan/detail/fit/raster/distances.cpp"
#include <hwy/foreach_target.h>
// after the line above, which includes this file once for each target
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace prostm::planning {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Finds the nearest centres for one vector of points, from `begin` on.
template <class D>
HWY_INLINE void NearestOf(D d, std::span<const float> x, std::span<const float> y,
                          std::span<const float> centre_x, std::span<const float> centre_y,
                          std::size_t begin, std::span<std::int32_t> nearest) {
  const hn::RebindToSigned<D> di;
  const auto px = hn::LoadU(d, x.data() + begin), py = hn::LoadU(d, y.data() + begin);
  auto least = hn::Set(d, hwy::HighestValue<float>());
  auto chosen = hn::Zero(di);
  for (std::size_t c = 0; c < centre_x.size(); ++c) {
    const auto dx = hn::Sub(px, hn::Set(d, centre_x[c]));
    const auto dy = hn::Sub(py, hn::Set(d, centre_y[c]));
    const auto squared = hn::MulAdd(dx, dx, hn::Mul(dy, dy));
    const auto nearer = hn::RebindMask(di, hn::Lt(squared, least));
    chosen = hn::IfThenElse(nearer, hn::Set(di, static_cast<std::int32_t>(c)), chosen);
    least = hn::Min(least, squared);
  }
  hn::StoreU(chosen, di, nearest.data() + begin);
}

void NearestCentres(std::span<const float> x, std::span<const float> y,
                    std::span<const float> centre_x, std::span<const float> centre_y,
                    std::span<std::int32_t> nearest) {
  const hn::CappedTag<float, 8> d;
  const hn::CappedTag<float, 1> one;
  const std::size_t n = x.size(), step = hn::Lanes(d);
  if (n < step) {
    for (std::size_t i = 0; i < n; ++i) NearestOf(one, x, y, centre_x, centre_y, i, nearest);
    return;
  }
  for (std::size_t i = 0; i + step <= n; i += step) {
    NearestOf(d, x, y, centre_x, centre_y, i, nearest);
  }
  // the last vector may overlap the one before it
  if (n % step != 0) NearestOf(d, x, y, centre_x, centre_y, n - step, nearest);
}

/// Packs each pair into 32 bits, the first node in the lower 16.
std::size_t PairsNear(const NodeArray& x, const NodeArray& y, std::size_t nodes, float distance,
                      std::uint32_t* packed) {
  const hn::CappedTag<float, 8> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  const hn::Rebind<std::uint8_t, decltype(d)> bytes;
  const std::size_t step = hn::Lanes(d);
  const auto limit = hn::Set(d, distance * distance);
  std::size_t count = 0;
  for (std::size_t a = 0; a + 1 < nodes; ++a) {
    const auto ax = hn::Set(d, x[a]), ay = hn::Set(d, y[a]);
    const auto first = hn::Set(du, static_cast<std::uint32_t>(a));
    const std::size_t begin = (a + 1) / step * step;
    unsigned behind = ~0U << (a + 1 - begin);
    for (std::size_t b = begin; b < nodes; b += step, behind = ~0U) {
      const auto dx = hn::Sub(hn::Load(d, x.data() + b), ax);
      const auto dy = hn::Sub(hn::Load(d, y.data() + b), ay);
      std::uint8_t bits[8] = {};
      hn::StoreMaskBits(d, hn::Lt(hn::MulAdd(dx, dx, hn::Mul(dy, dy)), limit), bits);
      unsigned found = bits[0] & behind & 0xffU;
      if (b + step > nodes) found &= (1U << (nodes - b)) - 1U;
      const auto places = hn::PromoteTo(du, hn::Load(bytes, kSetBits[found].data()));
      const auto second = hn::Add(places, hn::Set(du, static_cast<std::uint32_t>(b)));
      hn::StoreU(hn::Or(first, hn::ShiftLeft<16>(second)), du, packed + count);
      count += static_cast<std::size_t>(std::popcount(found));
    }
  }
  return count;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace prostm::planning
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace prostm::planning {

HWY_EXPORT(NearestCentres);
HWY_EXPORT(PairsNear);

void nearest_centres(std::span<const float> x, std::span<const float> y,
                     std::span<const float> centre_x, std::span<const float> centre_y,
                     std::span<std::int32_t> nearest) {
  HWY_DYNAMIC_DISPATCH(NearestCentres)(x, y, centre_x, centre_y, nearest);
}

NodePairs::NodePairs() : packed_(kMaxLoopNodes * (kMaxLoopNodes - 1) / 2 + 8) {}

void NodePairs::set(const NodeArray& x, const NodeArray& y, std::size_t nodes, float distance) {
  size_ = HWY_DYNAMIC_DISPATCH(PairsNear)(x, y, nodes, distance, packed_.data());
}

}  // namespace prostm::planning
#endif  // HWY_ONCE
