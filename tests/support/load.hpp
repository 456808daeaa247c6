#pragma once
/// The amount of work of long tests.

#include <cstdint>
#include <cstdlib>

namespace prostm::test {

/// Returns `count` in a plain build, and a twentieth of it under the address or thread sanitizer.
constexpr std::uint64_t reduced(std::uint64_t count) {
#ifdef PROSTM_SANITIZED
  return count / 20;
#else
  return count;
#endif
}

/// Range of seeds, [first, end), of a test over many random inputs.
struct Seeds {
  std::uint64_t first, end;
};

/// Returns `count` seeds (see reduced()), starting with 0, unless PROSTM_RANDOM_INPUTS and
/// PROSTM_FIRST_SEED specify others.
inline Seeds seeds(std::uint64_t count) {
  const auto number = [](const char* name, std::uint64_t otherwise) {
    const char* text = std::getenv(name);
    return text != nullptr ? std::strtoull(text, nullptr, 10) : otherwise;
  };
  const std::uint64_t first = number("PROSTM_FIRST_SEED", 0);
  return {first, first + number("PROSTM_RANDOM_INPUTS", reduced(count))};
}

}  // namespace prostm::test
