#include <cmath>
#include <sstream>
#include <stdexcept>

#include "emit/path_emitter.hpp"

namespace prostm {
namespace {

constexpr double kLongestWait = 1e6;  // [s]

void require(double value, double low, double high, const char* name) {
  if (std::isfinite(value) && value >= low && value <= high) return;
  std::ostringstream text;
  text << name << " = " << value << " must be between " << low << " and " << high;
  throw std::invalid_argument(text.str());
}

}  // namespace

void EmitSettings::visit(SettingsVisitor& v) {
  v.field("foci", foci);
  v.field("full_scale_pressure", full_scale_pressure);
  v.field("silent_below", silent_below);
  v.field("power_limit", power_limit);
  v.field("switch_at", switch_at);
  v.field("fade_time", fade_time);
  v.field("stall_time", stall_time);
  v.field("stall_fade_time", stall_fade_time);
}

void validate(const EmitSettings& settings, double sample_rate) {
  constexpr double kLargest = 1e300, kSmallest = 1e-300;
  require(settings.foci, 1, kMaxPaths, "foci");
  require(settings.full_scale_pressure, kSmallest, kLargest, "full_scale_pressure");
  require(settings.silent_below, 0.0, 0.999, "silent_below");
  require(settings.power_limit, 1e-6, kMaxPaths, "power_limit");
  require(settings.fade_time, 1e-6, 0.02, "fade_time");
  require(settings.stall_time, 1e-3, kLongestWait, "stall_time");
  require(settings.stall_fade_time, 1e-6, 0.04, "stall_fade_time");
  require(sample_rate, 1e3, 1e6, "sample_rate");
  if (settings.switch_at != "lap" && settings.switch_at != "now") {
    throw std::invalid_argument("switch_at = \"" + settings.switch_at +
                                "\" must be \"lap\" or \"now\"");
  }
}

}  // namespace prostm
