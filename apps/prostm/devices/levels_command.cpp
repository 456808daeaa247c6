#include <fmt/format.h>

#include <array>
#include <cmath>

#include "common.hpp"
#include "prostm/device/safety/safety_limiter.hpp"

namespace prostm::app {
namespace {

constexpr std::array<double, 5> kHeights = {0.10, 0.15, 0.20, 0.25, 0.30};  // [m]
constexpr double kReference = 20e-6;                                        // of 0 dB, rms [Pa]

/// The pressures at one focal point above the array's centre, at full drive.
struct FocusRow {
  double height = 0.0;                               ///< [m]
  double low = 0.0, high = 0.0;                      ///< acoustic, rms [Pa]
  double radiation_low = 0.0, radiation_high = 0.0;  ///< [Pa]
};

double decibels(double pressure) {
  return 20.0 * std::log10(pressure / kReference);
}

/// Returns the row of a height above the array's centre, which need not be D's origin.
FocusRow focus_row(const TransducerArray& array, double height) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : array.position) middle += p / static_cast<double>(array.position.size());
  const double high = full_pressure(array, middle + height * Vec3::UnitZ());
  const double low = high * smallest_amplitude(array) / largest_amplitude(array);
  return {height, low, high, radiation_pressure(low, Medium{}), radiation_pressure(high, Medium{})};
}

void print_caps(std::FILE* out, const PipelineSettings& settings) {
  fmt::print(out, "Caps ([safety]; lower ones can be set)\n");
  for (const SettingRow& row : setting_rows(group_of("safety", settings.safety).read)) {
    fmt::print(out, "  {:<24} {:>7} {:<3} {}\n", row.setting.name, row.value, row.setting.unit,
               row.setting.help);
  }
}

void print_foci(std::FILE* out, const TransducerArray& array, const std::vector<FocusRow>& rows) {
  fmt::print(out,
             "\nOne focal point at intensity 1 over the middle of {}, for {:g} to {:g} Pa·m\n"
             "  height   acoustic pressure, rms            radiation pressure on skin\n",
             array.name, smallest_amplitude(array), largest_amplitude(array));
  for (const FocusRow& row : rows) {
    fmt::print(out,
               "  {:>3.0f} mm   {:>5.0f} to {:>5.0f} Pa ({:.0f} to {:.0f} dB)   {:>4.0f} to "
               "{:>4.0f} Pa\n",
               1e3 * row.height, row.low, row.high, decibels(row.low), decibels(row.high),
               row.radiation_low, row.radiation_high);
  }
}

void print_heads(std::FILE* out, const std::vector<HeadLevel>& heads) {
  fmt::print(out,
             "\nSound level at the head at full drive, on the array's axis [dB re 20 µPa]\n"
             "  distance   least   taken   bound\n");
  for (const HeadLevel& head : heads) {
    fmt::print(out, "  {:>4.1f} m     {:>5.1f}   {:>5.1f}   {:>5.1f}\n", head.distance, head.low,
               head.estimate, head.bound);
  }
  fmt::print(out, "\nPublished limits around 40 kHz [dB re 20 µPa]\n");
  for (const ExposureLimit& limit : exposure_limits())
    fmt::print(out, "  {:>5.0f}   {} ({})\n", limit.level, limit.name, limit.source);
  fmt::print(out,
             "\nEvery array for touch exceeds the lower limits where a head can be. Levels and "
             "their uncertainty: docs/devices/safety.md\n");
}

nlohmann::ordered_json levels_json(const PipelineSettings& settings,
                                   const std::vector<FocusRow>& foci,
                                   const std::vector<HeadLevel>& heads) {
  const TransducerArray& array = settings.transducers;
  nlohmann::ordered_json json = {
      {"format", "prostm-levels/1"},
      {"array", array.name},
      {"amplitude_low_pa_m", smallest_amplitude(array)},
      {"amplitude_high_pa_m", largest_amplitude(array)},
      {"caps", settings_to_json({group_of("safety", settings.safety)})["safety"]}};
  for (const FocusRow& row : foci) {
    json["focus"].push_back({{"height_mm", 1e3 * row.height},
                             {"acoustic_low_pa", row.low},
                             {"acoustic_high_pa", row.high},
                             {"radiation_low_pa", row.radiation_low},
                             {"radiation_high_pa", row.radiation_high}});
  }
  for (const HeadLevel& head : heads) {
    json["head"].push_back({{"distance_m", head.distance},
                            {"low_db", head.low},
                            {"estimate_db", head.estimate},
                            {"bound_db", head.bound}});
  }
  for (const ExposureLimit& limit : exposure_limits()) {
    json["limits"].push_back(
        {{"name", limit.name}, {"level_db", limit.level}, {"source", limit.source}});
  }
  return json;
}

}  // namespace

int levels_command(const LevelsOptionsGiven& given) {
  const PipelineSettings settings = make_settings(given.common, std::nullopt);
  std::vector<FocusRow> foci;
  for (const double height : kHeights) foci.push_back(focus_row(settings.transducers, height));
  std::vector<HeadLevel> heads;
  for (const double distance : kHeadDistances)
    heads.push_back(head_level(settings.transducers, distance));
  std::FILE* out = prose(given.common.json);
  print_caps(out, settings);
  print_foci(out, settings.transducers, foci);
  print_heads(out, heads);
  write_json(given.common.json, levels_json(settings, foci, heads));
  return 0;
}

}  // namespace prostm::app
