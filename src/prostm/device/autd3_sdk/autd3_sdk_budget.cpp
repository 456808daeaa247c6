// Load of the link to AUTD3 units with the SDK's firmware.
#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "prostm/device/autd3_sdk/autd3_sdk_array.hpp"
#include "prostm/device/autd3_sdk/detail/autd3_sdk_wire.hpp"

namespace prostm {
namespace {

constexpr double kCarrier = 40e3;  // all sampling rates are fractions of it [Hz]
constexpr double kMostLoad = 0.5;
constexpr double kLongBlock = 20e-3, kShortBlock = 10e-3;  // [s]
constexpr int kLeastDivider = 4;                           // 10 kHz: higher rates gain nothing
constexpr int kMostDivider = 20;  // 2 kHz: at lower rates fingers feel the steps
constexpr int kTurnFrames = 2;    // frames that switch to a block and read the state

}  // namespace

Autd3SdkBudget autd3_sdk_budget(int slots, int divider, double block_time, double frames_per_ms) {
  Autd3SdkBudget budget;
  budget.slots = slots;
  budget.divider = divider;
  budget.block_samples = static_cast<int>(std::lround(block_time * kCarrier / divider));
  const int words = budget.block_samples * slots;
  budget.block_frames = (words + sdk::kFociPerFrame - 1) / sdk::kFociPerFrame + kTurnFrames;
  budget.block_time = budget.block_samples * divider / kCarrier;
  budget.load = budget.block_frames / (1e3 * budget.block_time * frames_per_ms);
  return budget;
}

Autd3SdkBudget best_autd3_sdk_budget(int slots, double frames_per_ms) {
  for (int divider = kLeastDivider; divider <= kMostDivider; ++divider) {
    for (const double block_time : {kShortBlock, kLongBlock}) {
      const Autd3SdkBudget budget = autd3_sdk_budget(slots, divider, block_time, frames_per_ms);
      if (budget.load <= kMostLoad) return budget;
    }
  }
  throw std::invalid_argument(
      fmt::format("the link takes {:.2f} frames per ms, too few for {} slots at 2 kHz; use fewer "
                  "focal points or a faster network",
                  frames_per_ms, slots));
}

}  // namespace prostm
