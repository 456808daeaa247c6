#include <array>

#include "prostm/emit/emitter.hpp"

namespace prostm {
namespace {

constexpr Quantity<EmitStats> count(const char* name, std::int64_t EmitStats::*number,
                                    const char* help, Better better = Better::Less) {
  return {.name = name, .unit = "", .help = help, .value = number, .better = better};
}

double share(std::int64_t part, std::int64_t all) {
  return all > 0 ? static_cast<double>(part) / static_cast<double>(all) : 0.0;
}
double faded_share(const EmitStats& s) {
  return share(s.faded, s.samples);
}

}  // namespace

double laps_completed(const EmitStats& s) {
  return 1.0 - share(s.laps_cut, s.laps_started);
}

namespace {

constexpr std::array kStats{
    count("samples", &EmitStats::samples, "Samples emitted, of all focal points.", Better::Neither),
    count("saturated", &EmitStats::saturated, "Samples clipped at full scale."),
    count("power_limited", &EmitStats::limited, "Samples scaled down by the power limit."),
    count("faded", &EmitStats::faded, "Samples in the fade of a transition."),
    Quantity<EmitStats>{.name = "faded_share",
                        .unit = "",
                        .help = "Share of samples in the fade of a transition.",
                        .value = &faded_share,
                        .better = Better::Less},
    count("laps_started", &EmitStats::laps_started, "Laps of paths begun.", Better::Neither),
    count("laps_cut", &EmitStats::laps_cut, "Laps cut short by a new plan."),
    Quantity<EmitStats>{.name = "laps_completed",
                        .unit = "",
                        .help = "Share of laps that were not cut short.",
                        .value = &laps_completed,
                        .better = Better::More},
    count("stalls", &EmitStats::stalls, "Fade-outs because no plan arrived."),
    count("refused_plans", &EmitStats::refused_plans,
          "Plans with a number that is not finite or out of bounds."),
    count("dropped_paths", &EmitStats::dropped_paths, "Paths beyond the number of focal points."),
    count("changed_paths", &EmitStats::changed_paths,
          "Paths played at another period than planned: the speed limit or the loop required it."),
    count("silenced", &EmitStats::silenced,
          "Samples silenced because their pressure was under the share silent_below."),
    Quantity<EmitStats>{.name = "max_focus_step_mm",
                        .unit = "mm",
                        .help = "Largest step of an audible focal point between two samples.",
                        .value = &EmitStats::max_focus_step,
                        .better = Better::Less,
                        .merge = Merge::Most,
                        .scale = 1e3},
};

}  // namespace

template <>
std::span<const Quantity<EmitStats>> quantities<EmitStats>() {
  return kStats;
}

}  // namespace prostm
