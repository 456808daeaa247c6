#include "plan/distances.hpp"

#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "plan/distances.cpp"
#include <hwy/foreach_target.h>
// after the line above, which includes this file once for each target
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace prostm::planning {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// For the points from `begin` on, one vector of them.
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
  // the last vector may do some points twice
  if (n % step != 0) NearestOf(d, x, y, centre_x, centre_y, n - step, nearest);
}

void NodesNear(const NodeArray& x, const NodeArray& y, std::size_t nodes, std::size_t first,
               float distance, NodeList& near) {
  const hn::CappedTag<float, 8> d;
  const hn::RebindToSigned<decltype(d)> di;
  const hn::Rebind<std::uint8_t, decltype(d)> bytes;
  const std::size_t step = hn::Lanes(d);
  const auto first_x = hn::Set(d, x[first]), first_y = hn::Set(d, y[first]);
  const auto limit = hn::Set(d, distance * distance);
  std::size_t count = 0;
  for (std::size_t b = first / step * step; b < nodes; b += step) {
    const auto dx = hn::Sub(hn::Load(d, x.data() + b), first_x);
    const auto dy = hn::Sub(hn::Load(d, y.data() + b), first_y);
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, hn::Lt(hn::MulAdd(dx, dx, hn::Mul(dy, dy)), limit), bits);
    unsigned found = bits[0];
    if (b <= first) found &= ~0U << (first + 1 - b);  // not before it, nor itself
    if (b + step > nodes) found &= (1U << (nodes - b)) - 1U;
    const auto places = hn::PromoteTo(di, hn::Load(bytes, kSetBits[found & 0xffU].data()));
    hn::StoreU(hn::Add(places, hn::Set(di, static_cast<std::int32_t>(b))), di,
               near.node.data() + count);
    count += static_cast<std::size_t>(std::popcount(found & 0xffU));
  }
  near.count = count;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace prostm::planning
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace prostm::planning {

HWY_EXPORT(NearestCentres);
HWY_EXPORT(NodesNear);

void nearest_centres(std::span<const float> x, std::span<const float> y,
                     std::span<const float> centre_x, std::span<const float> centre_y,
                     std::span<std::int32_t> nearest) {
  HWY_DYNAMIC_DISPATCH(NearestCentres)(x, y, centre_x, centre_y, nearest);
}

void nodes_near(const NodeArray& x, const NodeArray& y, std::size_t nodes, std::size_t first,
                float distance, NodeList& near) {
  HWY_DYNAMIC_DISPATCH(NodesNear)(x, y, nodes, first, distance, near);
}

}  // namespace prostm::planning
#endif  // HWY_ONCE
