#include "planner/vectors.hpp"

#include <fmt/core.h>
#include <hwy/targets.h>
#include <strings.h>

#include <cstdint>

#include "prostm/core/input_error.hpp"

namespace prostm::bench {

void limit_vectors(const std::string& name) {
  constexpr std::int64_t kPlain = HWY_EMU128 | HWY_SCALAR;
  std::int64_t allowed = name == "none" ? kPlain : 0;
  std::string known = "none";
  // listed from best to worst; the best has the lowest bit
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    if ((target & kPlain) != 0) continue;
    known += fmt::format(", {}", hwy::TargetName(target));
    if (strcasecmp(hwy::TargetName(target), name.c_str()) == 0) allowed = -target;
  }
  if (allowed == 0) {
    throw InputError(
        fmt::format("--vectors {} is not available here; choose from: {}", name, known));
  }
  hwy::SetSupportedTargetsForTest(allowed == kPlain ? kPlain : hwy::SupportedTargets() & allowed);
  hwy::GetChosenTarget().DeInit();
}

}  // namespace prostm::bench
