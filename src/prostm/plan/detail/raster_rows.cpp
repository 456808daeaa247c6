#include "prostm/plan/detail/raster_rows.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prostm/plan/detail/raster_rows.cpp"
#include <hwy/foreach_target.h>
// after the line above, which includes this file once for each target
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace prostm::planning {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<double, 8>;
using V = hn::Vec<D>;
using DI = hn::RebindToSigned<D>;

/// 1 for each lane whose byte is not 0, else 0.
HWY_INLINE V ones(const std::uint8_t* mask) {
  const hn::Rebind<std::int32_t, D> d32;
  const auto bytes = hn::LoadU(hn::Rebind<std::uint8_t, D>(), mask);
  return hn::PromoteTo(D(), hn::Min(hn::PromoteTo(d32, bytes), hn::Set(d32, 1)));
}

/// Returns the bits of a double as an integer, which has the same order as non-negative doubles; −0
/// counts as 0.
std::int64_t bits_of(double value) {
  return std::bit_cast<std::int64_t>(value + 0.0);
}

double CheckedMaximum(std::span<const double> values, std::span<const std::uint8_t> skin,
                      double most) {
  const D d;
  const DI di;
  const hn::Rebind<std::int32_t, D> di32;
  const hn::Rebind<std::uint8_t, D> bytes;
  const std::size_t n = values.size(), step = hn::Lanes(d);
  const std::int64_t limit = bits_of(most);
  const auto limits = hn::Set(di, limit);
  // negative where a value was negative or above the limit
  auto bad = hn::Zero(di), on_skin = hn::Zero(di);
  std::size_t i = 0;
  for (; i + step <= n; i += step) {
    const auto bits = hn::BitCast(di, hn::Add(hn::LoadU(d, values.data() + i), hn::Zero(d)));
    bad = hn::Or(bad, hn::Or(bits, hn::VecFromMask(di, hn::Gt(bits, limits))));
    const auto wide = hn::PromoteTo(di32, hn::LoadU(bytes, skin.data() + i));
    const auto counts = hn::Gt(hn::PromoteTo(di, wide), hn::Zero(di));
    on_skin = hn::IfThenElse(hn::Gt(hn::IfThenElseZero(counts, bits), on_skin), bits, on_skin);
  }
  bool is_bad = hn::GetLane(hn::MinOfLanes(di, bad)) < 0;
  std::int64_t highest = hn::GetLane(hn::MaxOfLanes(di, on_skin));
  for (; i < n; ++i) {
    const std::int64_t bits = bits_of(values[i]);
    is_bad = is_bad || bits < 0 || bits > limit;
    if (skin[i] != 0) highest = std::max(highest, bits);
  }
  return is_bad ? -1.0 : std::bit_cast<double>(highest);
}

void SumRows(std::span<const double> values, std::span<const std::uint8_t> skin, int begin, int end,
             const ColumnSums& sums) {
  const D d;
  const std::size_t n = sums.value.size(), step = hn::Lanes(d);
  const std::size_t first = static_cast<std::size_t>(begin) * n;
  const std::size_t last = static_cast<std::size_t>(end) * n;
  const auto first_row = static_cast<double>(begin);
  std::size_t col = 0;
  for (; col + step <= n; col += step) {
    V value = hn::Zero(d), count = hn::Zero(d), rows = hn::Zero(d), row = hn::Set(d, first_row);
    for (std::size_t i = first + col; i < last; i += n) {
      const V one = ones(skin.data() + i);
      value = hn::MulAdd(one, hn::LoadU(d, values.data() + i), value);
      count = hn::Add(count, one);
      rows = hn::MulAdd(one, row, rows);
      row = hn::Add(row, hn::Set(d, 1.0));
    }
    hn::StoreU(value, d, sums.value.data() + col);
    hn::StoreU(count, d, sums.count.data() + col);
    hn::StoreU(rows, d, sums.row.data() + col);
  }
  for (; col < n; ++col) {
    sums.value[col] = sums.count[col] = sums.row[col] = 0.0;
    for (int row = begin; row < end; ++row) {
      const std::size_t i = static_cast<std::size_t>(row) * n + col;
      if (skin[i] == 0) continue;
      sums.value[col] += values[i];
      sums.count[col] += 1.0;
      sums.row[col] += row;
    }
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace prostm::planning
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace prostm::planning {
namespace {

HWY_EXPORT(CheckedMaximum);
HWY_EXPORT(SumRows);

}  // namespace

double checked_maximum(std::span<const double> values, std::span<const std::uint8_t> skin,
                       double most) {
  return HWY_DYNAMIC_DISPATCH(CheckedMaximum)(values, skin, most);
}

void sum_rows(std::span<const double> values, std::span<const std::uint8_t> skin, int begin,
              int end, const ColumnSums& sums) {
  HWY_DYNAMIC_DISPATCH(SumRows)(values, skin, begin, end, sums);
}

}  // namespace prostm::planning
#endif  // HWY_ONCE
