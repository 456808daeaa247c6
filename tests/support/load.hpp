#pragma once
/// How much of a long test a sanitizer build runs.

#include <cstdint>

namespace prostm::test {

/// `count` in a plain build, a twentieth of it under the address or the thread sanitizer.
constexpr std::uint64_t reduced(std::uint64_t count) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return count / 20;
#else
  return count;
#endif
}

}  // namespace prostm::test
