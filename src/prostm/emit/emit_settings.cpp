#include <stdexcept>

#include "prostm/core/require.hpp"
#include "prostm/emit/detail/envelope.hpp"
#include "prostm/emit/emitter.hpp"

namespace prostm {

void EmitSettings::visit(SettingsVisitor& v) {
  v.field("foci", foci);
  v.field("full_scale_pressure", full_scale_pressure);
  v.field("silent_below", silent_below);
  v.field("power_limit", power_limit);
  v.field("tilt_bound", tilt_bound);
  v.field("switch_at", switch_at);
  v.field("fade_time", fade_time);
  v.field("stall_time", stall_time);
  v.field("stall_fade_time", stall_fade_time);
  v.field("am_frequency", am_frequency);
  v.field("am_waveform", am_waveform);
}

void validate(const EmitSettings& settings, double sample_rate) {
  constexpr double kMaxPressure = 1e300, kMinPressure = 1e-300;  // [Pa]
  constexpr double kMaxWait = 1e6;                               // [s]
  require_between("foci", settings.foci, 1, kMaxPaths);
  require_between("full_scale_pressure", settings.full_scale_pressure, kMinPressure, kMaxPressure,
                  "Pa");
  require_between("silent_below", settings.silent_below, 0.0, 0.999);
  require_between("power_limit", settings.power_limit, 1e-6, double{kMaxPaths});
  require_between("tilt_bound", settings.tilt_bound, 1.0, 4.0);
  require_between("fade_time", settings.fade_time, 1e-6, 0.02, "s");
  require_between("stall_time", settings.stall_time, 1e-3, kMaxWait, "s");
  require_between("stall_fade_time", settings.stall_fade_time, 1e-6, 0.04, "s");
  require_between("sample_rate", sample_rate, 1e3, 1e6, "Hz");
  if (settings.switch_at != "lap" && settings.switch_at != "now") {
    throw std::invalid_argument("switch_at = \"" + settings.switch_at +
                                "\" must be \"lap\" or \"now\"");
  }
  waveform_from_name(settings.am_waveform);
}

}  // namespace prostm
