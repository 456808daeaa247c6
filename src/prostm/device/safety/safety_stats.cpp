// Statistics of the limiter.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "prostm/device/safety/safety_limiter.hpp"

namespace prostm {
namespace {

constexpr const char* kGroup = "safety";

constexpr Quantity<SafetyStats> count(const char* name, std::int64_t SafetyStats::*number,
                                      const char* help) {
  return {.name = name,
          .unit = "",
          .help = help,
          .value = number,
          .better = Better::Less,
          .group = kGroup};
}

constexpr Quantity<SafetyStats> level(const char* name, const char* unit,
                                      double SafetyStats::*number, const char* help) {
  return {.name = name,
          .unit = unit,
          .help = help,
          .value = number,
          .merge = Merge::Most,
          .group = kGroup};
}

using S = SafetyStats;

constexpr std::array kStats{
    count("not_finite", &S::not_finite, "Samples with a number that was not finite."),
    count("out_of_range", &S::out_of_range, "Samples with an intensity outside 0 to 1."),
    count("change", &S::change, "Samples whose intensity changed too fast."),
    count("power", &S::power, "Samples above the limit on power."),
    count("place", &S::place, "Samples at positions where the array's levels are not known."),
    count("intensity", &S::intensity, "Samples above the cap on intensity."),
    count("acoustic_pressure", &S::acoustic_pressure,
          "Samples above the cap on acoustic pressure."),
    count("radiation_pressure", &S::radiation_pressure,
          "Samples above the cap on radiation pressure."),
    count("mean_radiation_pressure", &S::mean_radiation_pressure,
          "Samples above the cap on mean radiation pressure."),
    count("head_level", &S::head_level, "Samples above the cap on the level at the head."),
    count("jump", &S::jump, "Samples held because of a jump, until silent."),
    count("ramp", &S::ramp, "Samples in a ramp after the start, silence or a mute."),
    level("acoustic_low_pa", "Pa", &S::acoustic_low,
          "Largest acoustic pressure, rms: lower bound."),
    level("acoustic_likely_pa", "Pa", &S::acoustic_likely,
          "Largest acoustic pressure, rms: likely value."),
    level("acoustic_high_pa", "Pa", &S::acoustic_high,
          "Largest acoustic pressure, rms: upper bound."),
    level("radiation_low_pa", "Pa", &S::radiation_low, "Largest radiation pressure: lower bound."),
    level("radiation_likely_pa", "Pa", &S::radiation_likely,
          "Largest radiation pressure: likely value."),
    level("radiation_high_pa", "Pa", &S::radiation_high,
          "Largest radiation pressure: upper bound."),
    level("mean_low_pa", "Pa", &S::mean_low, "Largest mean radiation pressure: lower bound."),
    level("mean_high_pa", "Pa", &S::mean_high, "Largest mean radiation pressure: upper bound."),
    level("head_low_db", "dB", &S::head_low, "Largest mean sound level at the head: lower bound."),
    level("head_likely_db", "dB", &S::head_likely,
          "Largest mean sound level at the head: likely value."),
    level("head_estimate_db", "dB", &S::head_estimate,
          "Largest mean sound level at the head: the estimate that is capped."),
    level("head_bound_db", "dB", &S::head_bound,
          "Largest mean sound level at the head: upper bound, all transducers in phase."),
};

/// Returns the level for a mean share of a full drive's energy; 0 for silence.
double at_share(double full_drive, float share) {
  return share > 0.0F ? std::max(0.0, full_drive + 10.0 * std::log10(static_cast<double>(share)))
                      : 0.0;
}

}  // namespace

template <>
std::span<const Quantity<SafetyStats>> quantities<SafetyStats>() {
  return kStats;
}

std::int64_t erred_samples(const SafetyStats& s) {
  return s.not_finite + s.out_of_range + s.change + s.power;
}

std::int64_t capped_samples(const SafetyStats& s) {
  return s.place + s.intensity + s.acoustic_pressure + s.radiation_pressure +
         s.mean_radiation_pressure + s.head_level;
}

const char* main_cap(const SafetyStats& s) {
  const std::pair<std::int64_t, const char*> caps[] = {
      {s.place, "place"},
      {s.intensity, "intensity"},
      {s.acoustic_pressure, "acoustic_pressure"},
      {s.radiation_pressure, "radiation_pressure"},
      {s.mean_radiation_pressure, "mean_radiation_pressure"},
      {s.head_level, "head_level"}};
  return std::max_element(std::begin(caps), std::end(caps),
                          [](const auto& a, const auto& b) { return a.first < b.first; })
      ->second;
}

SafetyStats SafetyLimiter::stats() const {
  SafetyStats s;
  const auto counted = [&](SafetyLimit limit) {
    return published_counts_[static_cast<std::size_t>(limit)].load(std::memory_order_relaxed);
  };
  s.not_finite = counted(SafetyLimit::NotFinite);
  s.out_of_range = counted(SafetyLimit::OutOfRange);
  s.place = counted(SafetyLimit::Place);
  s.intensity = counted(SafetyLimit::Intensity);
  s.change = counted(SafetyLimit::Change);
  s.power = counted(SafetyLimit::Power);
  s.acoustic_pressure = counted(SafetyLimit::AcousticPressure);
  s.radiation_pressure = counted(SafetyLimit::RadiationPressure);
  s.mean_radiation_pressure = counted(SafetyLimit::MeanRadiationPressure);
  s.head_level = counted(SafetyLimit::HeadLevel);
  s.jump = counted(SafetyLimit::Jump);
  s.ramp = counted(SafetyLimit::Ramp);
  if (!limits_.levels) return s;
  const auto reached = [&](std::size_t i) {
    return published_levels_[i].load(std::memory_order_relaxed);
  };
  const double per_square = limits_.levels->radiation_per_square;
  s.acoustic_low = static_cast<double>(reached(0));
  s.acoustic_likely = limits_.levels->likely_by_low * s.acoustic_low;
  s.acoustic_high = static_cast<double>(reached(1));
  s.radiation_low = per_square * s.acoustic_low * s.acoustic_low;
  s.radiation_likely = per_square * s.acoustic_likely * s.acoustic_likely;
  s.radiation_high = per_square * s.acoustic_high * s.acoustic_high;
  s.mean_low = static_cast<double>(reached(2));
  s.mean_high = static_cast<double>(reached(3));
  const HeadLevel& head = limits_.levels->head;
  s.head_low = at_share(head.low, reached(4));
  s.head_likely = at_share(head.likely, reached(4));
  s.head_estimate = at_share(head.estimate, reached(5));
  s.head_bound = at_share(head.bound, reached(5));
  return s;
}

}  // namespace prostm
