#pragma once
/// Tests of vector kernels on every set of instructions that this processor has.

#include <hwy/targets.h>

#include <cstdint>

namespace prostm::test {

/// Lets kernels use these targets alone, until it goes.
class OnlyTargets {
 public:
  explicit OnlyTargets(std::int64_t targets) { set(targets); }
  ~OnlyTargets() { set(0); }
  OnlyTargets(const OnlyTargets&) = delete;
  OnlyTargets& operator=(const OnlyTargets&) = delete;

 private:
  static void set(std::int64_t targets) {
    hwy::SetSupportedTargetsForTest(targets);
    hwy::GetChosenTarget().DeInit();
  }
};

/// Highway's one-lane fallback.
inline constexpr std::int64_t kPlainTarget = HWY_EMU128 | HWY_SCALAR;

/// Those of this processor, the best one in the lowest bit.
inline std::int64_t vector_targets() {
  return hwy::SupportedTargets() & HWY_TARGETS & ~kPlainTarget;
}

}  // namespace prostm::test
