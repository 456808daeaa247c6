#include "prostm/fluid/detail/largest.hpp"

#include <algorithm>

// a plain loop, compiled for each vector width
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prostm/fluid/detail/largest.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace prostm::fluid {
namespace HWY_NAMESPACE {
namespace {

std::int32_t LargestBits(const float* begin, const float* end) {
  std::int32_t largest = 0;
  for (const float* x = begin; x != end; ++x)
    largest = std::max(largest, std::bit_cast<std::int32_t>(*x) & 0x7fffffff);
  return largest;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace prostm::fluid
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace prostm::fluid {
namespace {

HWY_EXPORT(LargestBits);

}  // namespace

std::int32_t largest_bits(const float* begin, const float* end) {
  return HWY_DYNAMIC_DISPATCH(LargestBits)(begin, end);
}

}  // namespace prostm::fluid
#endif  // HWY_ONCE
