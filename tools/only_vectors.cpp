/// Limits a program's kernels to the vector instructions that ONLY_VECTORS names, or to the plain
/// code for "none", when it is loaded before the program (LD_PRELOAD). It works with programs of
/// any commit, so the shipped program needs no switch for it.

#include <hwy/targets.h>
#include <strings.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

constexpr std::int64_t kPlain = HWY_EMU128 | HWY_SCALAR;

/// Calls `visit` with each set of vector instructions of this processor, the best one first.
template <class Visit>
void for_each_target(Visit visit) {
  for (std::int64_t left = hwy::SupportedTargets() & HWY_TARGETS & ~kPlain; left != 0;
       left &= left - 1) {
    visit(left & -left);
  }
}

[[gnu::constructor]] void limit() {
  const char* name = std::getenv("ONLY_VECTORS");
  if (name == nullptr) return;
  std::int64_t only = std::strcmp(name, "none") == 0 ? kPlain : 0;
  for_each_target([&](std::int64_t target) {
    if (strcasecmp(hwy::TargetName(target), name) == 0) only = target;
  });
  if (only == 0) {
    std::fprintf(stderr, "only_vectors: this processor has no %s\n", name);
    std::_Exit(2);
  }
  hwy::SetSupportedTargetsForTest(only);
  hwy::GetChosenTarget().DeInit();
}

}  // namespace

/// Writes the names of these sets to `out`, separated by spaces.
extern "C" void list_vectors(char* out, int size) {
  int used = 0;
  for_each_target([&](std::int64_t target) {
    if (used < size) {
      used += std::snprintf(out + used, static_cast<std::size_t>(size - used), "%s ",
                            hwy::TargetName(target));
    }
  });
}
