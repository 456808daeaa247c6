#include <cmath>

#include "prostm/core/require.hpp"
#include "prostm/emit/emitter.hpp"

namespace prostm {
namespace {

constexpr double kMostPressure = 1e300, kLeastPressure = 1e-300;  // [unit of the target]

template <class Settings, class Visitor>
void list(Settings& s, Visitor& v) {
  v.field({"foci", "", 1, kMaxPaths, "number of focal points"}, s.foci);
  v.field({"full_scale_pressure", "Pa", 0, kMostPressure,
           "rendered pressure at intensity 1; 0: the "
           "scene's, or gain times the largest"},
          s.full_scale_pressure);
  v.field({"silent_below", "", 0, 0.999, "share of full scale under which a sample is silent"},
          s.silent_below);
  v.field({"power_limit", "", 1e-6, kMaxPaths, "largest sum of squared intensities at a time"},
          s.power_limit);
  v.field({"tilt_bound", "", 1, 4, "largest factor that compensates for tilted skin; 1: none"},
          s.tilt_bound);
  v.field({.name = "switch_at", .help = "when a new plan takes over"}, s.switch_at);
  v.field({"fade_time", "s", 1e-6, 0.02, "time of a fade over the full range; at least 40 samples"},
          s.fade_time);
  v.field({"stall_time", "s", 1e-3, 1e6, "time without a new plan after which output fades"},
          s.stall_time);
  v.field({"stall_fade_time", "s", 1e-6, 0.04, "time of the fade after stall_time"},
          s.stall_fade_time);
  v.field({"am_frequency", "Hz", 25, 1e4,
           "frequency of the modulation of method am; at most a 126th of the sample rate"},
          s.am_frequency);
  v.field({.name = "am_waveform", .help = "waveform of the modulation of method am"},
          s.am_waveform);
}

}  // namespace

void EmitSettings::visit(SettingsReader& v) const {
  list(*this, v);
}
void EmitSettings::visit(SettingsWriter& v) {
  list(*this, v);
}

int am_period(const EmitSettings& settings, double sample_rate) {
  // Both waveforms change by at most π/n a sample: with n = 126 by less than 1/40
  constexpr double kShortestPeriod = 126.0;  // [samples]
  constexpr double kLowestFrequency = 25.0;  // [Hz], so that output is silent 40 ms after a loss
  require_between("sample_rate", sample_rate, kShortestPeriod * kLowestFrequency, 1e6, "Hz");
  require_between("am_frequency", settings.am_frequency, kLowestFrequency,
                  sample_rate / kShortestPeriod, "Hz");
  return static_cast<int>(std::lround(sample_rate / settings.am_frequency));
}

void validate(const EmitSettings& settings, double sample_rate) {
  require_bounds(settings);
  require_between("full_scale_pressure", settings.full_scale_pressure, kLeastPressure,
                  kMostPressure, "Pa");
  require_between("sample_rate", sample_rate, 1e3, 1e6, "Hz");
}

}  // namespace prostm
