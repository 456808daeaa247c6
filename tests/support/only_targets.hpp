#pragma once
/// Tests of vector kernels on every vector target of this processor.

#include <hwy/targets.h>

#include <cstdint>

namespace prostm::test {

/// Restricts kernels to these targets during its lifetime.
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

/// Returns the targets of this processor, with the best one in the lowest bit.
inline std::int64_t vector_targets() {
  return hwy::SupportedTargets() & HWY_TARGETS & ~kPlainTarget;
}

}  // namespace prostm::test
