#include "prostm/device/autd3/autd3_budget.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "prostm/device/autd3/detail/autd3_frames.hpp"
#include "prostm/device/autd3/detail/autd3_timing.hpp"

namespace prostm {
namespace {

constexpr int kLeastDivider = 4;  // 10 kHz: higher rates gain nothing
constexpr int kMostDivider = 20;  // 2 kHz: at lower rates fingers feel the steps
constexpr double kMostUrgency = 0.9;

}  // namespace

double Autd3Budget::sample_rate() const {
  return autd3::kCarrier / divider;
}

double Autd3Budget::step() const {
  return kAutd3DrawSpeed / sample_rate();
}

int autd3_frames(int slots, int samples) {
  return autd3::foci_frames(slots, samples);
}

Autd3Budget autd3_budget(int slots, int divider, double block_time, double frames_per_ms,
                         double slow_frame) {
  Autd3Budget budget;
  budget.slots = slots;
  budget.divider = divider;
  budget.block_samples = static_cast<int>(std::lround(block_time * autd3::kCarrier / divider));
  budget.block_frames = autd3_frames(slots, budget.block_samples);
  budget.block_time = budget.block_samples * divider / autd3::kCarrier;
  budget.frames_per_ms = frames_per_ms;
  const double frame_time = 1e-3 / frames_per_ms;
  const double writing = frame_time * (budget.block_frames + 1);
  budget.load = writing / budget.block_time;
  const double available = budget.block_time - autd3::kSeen - autd3::kRamp -
                           autd3::early(std::max(slow_frame, frame_time));
  budget.urgency = available > 0.0 ? writing / available : HUGE_VAL;
  return budget;
}

Autd3Budget best_autd3_budget(int slots, double frames_per_ms, double slow_frame,
                              double block_time) {
  for (int divider = kLeastDivider; divider <= kMostDivider; ++divider) {
    for (const double usual : {kAutd3ShortBlock, kAutd3LongBlock}) {
      const Autd3Budget budget = autd3_budget(slots, divider, block_time > 0.0 ? block_time : usual,
                                              frames_per_ms, slow_frame);
      if (budget.urgency <= kMostUrgency) return budget;
    }
  }
  throw std::invalid_argument(fmt::format(
      "the link takes {:.2f} frames per ms, too few for {} slots at 2 kHz: use fewer focal points, "
      "set [autd3] weights = false, or take a faster network",
      frames_per_ms, slots));
}

std::vector<Autd3Budget> autd3_budgets() {
  std::vector<Autd3Budget> rows;
  for (const int slots : {1, 2, 4, 8})
    for (const int divider : {1, 2, 3, 4, 5, 6, 8, 10})
      for (const double block_time : {10e-3, 20e-3, 40e-3})
        for (const double frames_per_ms : {0.5, 1.0, 2.0})
          rows.push_back(autd3_budget(slots, divider, block_time, frames_per_ms));
  return rows;
}

}  // namespace prostm
