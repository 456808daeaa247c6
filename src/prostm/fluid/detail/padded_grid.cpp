#include "prostm/fluid/detail/padded_grid.hpp"

#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace prostm::fluid {
namespace {

constexpr std::size_t kHugePage = std::size_t{2} << 20;

bool is_large(std::size_t bytes) {
  return bytes >= kHugePage / 2;
}

std::align_val_t alignment(std::size_t bytes) {
  return std::align_val_t{is_large(bytes) ? kHugePage : 64};
}

/// Rounds a large size up to whole pages.
std::size_t rounded(std::size_t bytes) {
  return is_large(bytes) ? (bytes + kHugePage - 1) / kHugePage * kHugePage : bytes;
}

}  // namespace

void* allocate_field(std::size_t bytes) {
  void* memory = ::operator new(rounded(bytes), alignment(bytes));
#if defined(__linux__)
  // a kernel without huge pages uses small ones
  if (is_large(bytes)) madvise(memory, rounded(bytes), MADV_HUGEPAGE);
#endif
  return memory;
}

void free_field(void* memory, std::size_t bytes) {
  ::operator delete(memory, alignment(bytes));
}

}  // namespace prostm::fluid
