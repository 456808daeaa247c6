#pragma once
/// Searches in rows of bytes.

#include <cstdint>
#include <cstring>

namespace prostm::fluid {

/// Calls f(i) for the bytes i in [begin, end) of a row that equal `value` when they are visited.
template <class F>
void for_bytes(const std::uint8_t* row, int begin, int end, std::uint8_t value, F&& f) {
  for (int i = begin; i < end; ++i) {
    const void* const found = std::memchr(row + i, value, static_cast<std::size_t>(end - i));
    if (found == nullptr) return;
    i = static_cast<int>(static_cast<const std::uint8_t*>(found) - row);
    f(i);
  }
}

}  // namespace prostm::fluid
