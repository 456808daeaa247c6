#include <fmt/format.h>

#include <array>
#include <cmath>

#include "common.hpp"
#include "prostm/device/safety/safety_limiter.hpp"

namespace prostm::app {
namespace {

constexpr std::array<double, 5> kHeights = {0.10, 0.15, 0.20, 0.25, 0.30};  // [m]
constexpr double kReference = 20e-6;                                        // of 0 dB, rms [Pa]

/// A value and its bounds.
struct Interval {
  double value = 0.0, low = 0.0, high = 0.0;
};
/// The pressures at one focal point above the array's centre, at full drive.
struct FocusRow {
  double height = 0.0;  ///< [m]
  Interval acoustic;    ///< rms [Pa]
  Interval radiation;   ///< on the skin [Pa]
};

double decibels(double pressure) {
  return 20.0 * std::log10(pressure / kReference);
}

/// Returns the row of a height above the array's centre, which need not be D's origin.
FocusRow focus_row(const TransducerArray& array, double height) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : array.position) middle += p / static_cast<double>(array.position.size());
  const Vec3 focus = middle + height * Vec3::UnitZ();
  const Interval acoustic = {absorbed_pressure(array, focus, likely_amplitude(array)),
                             absorbed_pressure(array, focus, smallest_amplitude(array)),
                             full_pressure(array, focus)};
  const auto radiation = [](double p) { return radiation_pressure(p, Medium{}); };
  return {height,
          acoustic,
          {radiation(acoustic.value), radiation(acoustic.low), radiation(acoustic.high)}};
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
             "\nOne focal point at intensity 1 over the middle of {}, for {:.3g} Pa·m ({:.3g} to "
             "{:.3g})\n"
             "  height   sound pressure, rms                      radiation pressure on the skin\n",
             array.name, likely_amplitude(array), smallest_amplitude(array),
             largest_amplitude(array));
  for (const FocusRow& row : rows) {
    fmt::print(
        out,
        "  {:>3.0f} mm   {:>4.1f} kPa ({:.1f} to {:.1f}), {:.0f} dB ({:.0f} to {:.0f})   {:>4.0f} "
        "Pa ({:.0f} to {:.0f})\n",
        1e3 * row.height, 1e-3 * row.acoustic.value, 1e-3 * row.acoustic.low,
        1e-3 * row.acoustic.high, decibels(row.acoustic.value), decibels(row.acoustic.low),
        decibels(row.acoustic.high), row.radiation.value, row.radiation.low, row.radiation.high);
  }
}

void print_heads(std::FILE* out, const std::vector<HeadLevel>& heads) {
  fmt::print(out,
             "\nSound level at the head at full drive, on the array's axis [dB re 20 µPa]\n"
             "  distance   about (from to)   for the cap\n");
  for (const HeadLevel& head : heads) {
    fmt::print(out, "  {:>4.1f} m     {:>4.0f} ({:.0f} to {:.0f})   {:>8.0f}\n", head.distance,
               head.likely, head.low, head.bound, head.estimate);
  }
  fmt::print(out, "\nPublished limits in the third of an octave around 40 kHz [dB re 20 µPa]\n");
  for (const ExposureLimit& limit : exposure_limits()) {
    fmt::print(out, "  {:>5.0f}   {}: {} ({})\n", limit.level, limit.name, limit.scope,
               limit.source);
  }
}

void print_advice(std::FILE* out, const HeadLevel& head) {
  fmt::print(out, "\nRecommended settings, for a head {:g} m from the array\n", head.distance);
  for (const RecommendedLevel& of : recommended_levels(head)) {
    const std::string at_ear =
        of.protection > 0.0
            ? fmt::format(", {:.0f} dB behind hearing protection", of.level - of.protection)
            : std::string();
    const std::string cost =
        of.cost > 0.0 ? fmt::format("felt strength {:.0f} dB below that at full output", of.cost)
                      : std::string("felt as strongly as at full output");
    fmt::print(out, "  {:<6} [safety] head_level = {:.0f}: about {:.0f} dB{}; {}\n         {}\n",
               of.use, of.cap, of.level, at_ear, cost, of.advice);
  }
  fmt::print(out, "\nLevels and their uncertainty: docs/devices/safety.md\n");
}

nlohmann::ordered_json levels_json(const PipelineSettings& settings,
                                   const std::vector<FocusRow>& foci,
                                   const std::vector<HeadLevel>& heads) {
  const TransducerArray& array = settings.transducers;
  nlohmann::ordered_json json = {
      {"format", "prostm-levels/1"},
      {"array", array.name},
      {"amplitude_pa_m", likely_amplitude(array)},
      {"amplitude_low_pa_m", smallest_amplitude(array)},
      {"amplitude_high_pa_m", largest_amplitude(array)},
      {"caps", settings_to_json({group_of("safety", settings.safety)})["safety"]}};
  for (const FocusRow& row : foci) {
    json["focus"].push_back({{"height_mm", 1e3 * row.height},
                             {"acoustic_pa", row.acoustic.value},
                             {"acoustic_low_pa", row.acoustic.low},
                             {"acoustic_high_pa", row.acoustic.high},
                             {"radiation_pa", row.radiation.value},
                             {"radiation_low_pa", row.radiation.low},
                             {"radiation_high_pa", row.radiation.high}});
  }
  for (const HeadLevel& head : heads) {
    json["head"].push_back({{"distance_m", head.distance},
                            {"likely_db", head.likely},
                            {"low_db", head.low},
                            {"estimate_db", head.estimate},
                            {"bound_db", head.bound}});
  }
  for (const ExposureLimit& limit : exposure_limits()) {
    json["limits"].push_back({{"name", limit.name},
                              {"level_db", limit.level},
                              {"scope", limit.scope},
                              {"source", limit.source}});
  }
  const double distance = settings.safety.head_distance;
  for (const RecommendedLevel& of : recommended_levels(head_level(array, distance))) {
    json["recommended"].push_back({{"use", of.use},
                                   {"head_level_db", of.cap},
                                   {"head_distance_m", distance},
                                   {"likely_db", of.level},
                                   {"protection_db", of.protection},
                                   {"felt_strength_lost_db", of.cost},
                                   {"advice", of.advice}});
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
  print_advice(out, head_level(settings.transducers, settings.safety.head_distance));
  write_json(given.common.json, levels_json(settings, foci, heads));
  return 0;
}

}  // namespace prostm::app
