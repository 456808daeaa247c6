#include "prostm/pipeline/playable.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "prostm/emit/drive.hpp"

namespace prostm {
namespace {

constexpr double kRounding = 1e-9;

[[noreturn]] void fail(const char* setting, double value, const char* unit, double most,
                       const std::string& reason) {
  throw std::invalid_argument(fmt::format("{} = {:g}{} must be at most {:.4g}{}, {}", setting,
                                          value, unit, most, unit, reason));
}

/// Checks the speed of paths. Devices that round positions have a limit below kMaxFocusSpeed.
void check_speed(const PlanSettings& plan, const DeviceInfo& device) {
  const double most =
      device.place_unit == 0.0 ? kMaxFocusSpeed : kStepMargin * device.max_focus_speed();
  if (plan.speed > most * (1.0 + kRounding)) {
    fail("plan.speed", plan.speed, " m/s", most,
         fmt::format("the limit of focal points on {}", device.name));
  }
}

/// Checks that a fade over the full range does not exceed the largest slew.
void check_fade(const char* setting, double time, double sample_rate) {
  const double least = 1.0 / (largest_slew(time, sample_rate) * sample_rate);
  if (time * (1.0 + kRounding) >= least) return;
  throw std::invalid_argument(
      fmt::format("{} = {:g} s must be at least {:g} s, 40 samples at {:g} kHz", setting, time,
                  least, 1e-3 * sample_rate));
}

/// A cap lowers the default power limit, and plans and files then state the lower value; a limit
/// set above the cap is an error.
void check_power(const PipelineSettings& settings) {
  const double limit = settings.emit.power_limit, cap = settings.safety.power;
  if (limit <= cap || limit <= EmitSettings().power_limit) return;
  fail("emit.power_limit", limit, "", cap, "[safety] power");
}

}  // namespace

void require_playable(const PipelineSettings& settings, const DeviceInfo& device) {
  const double rate = device.emission_rate();
  if (settings.method == Method::Am) {
    validate(settings.am);
    static_cast<void>(am_period(settings.emit, rate));
  } else {
    check_speed(settings.plan, device);
    validate(settings.plan);
    check_fade("emit.fade_time", settings.emit.fade_time, rate);
    check_fade("emit.stall_fade_time", settings.emit.stall_fade_time, rate);
  }
  check_power(settings);
}

}  // namespace prostm
