#include "prostm/device/safety/safety_settings.hpp"

namespace prostm {
namespace {

template <class Settings, class Visitor>
void list(Settings& s, Visitor& v) {
  v.field({"intensity", "", 1e-3, 1, "largest intensity of a focal point"}, s.intensity);
  v.field({"power", "", 1e-6, 4, "largest sum of squared intensities of a sample"}, s.power);
  v.field({"acoustic_pressure", "Pa", 1, 14.6e3, "largest rms acoustic pressure at a focal point"},
          s.acoustic_pressure);
  v.field({"radiation_pressure", "Pa", 0.01, 3e3, "largest radiation pressure at a focal point"},
          s.radiation_pressure);
  v.field({"mean_radiation_pressure", "Pa", 0.01, 2.5e3,
           "largest mean over a second of the radiation pressure at a focal point"},
          s.mean_radiation_pressure);
  v.field({"head_level", "dB", 60, 145, "largest sound level at the head, mean over a second"},
          s.head_level);
  v.field({"head_distance", "m", 0.3, 0.5, "distance of the head from the array"}, s.head_distance);
}

}  // namespace

void SafetySettings::visit(SettingsReader& v) const {
  list(*this, v);
}
void SafetySettings::visit(SettingsWriter& v) {
  list(*this, v);
}

}  // namespace prostm
