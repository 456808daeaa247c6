#include <array>

#include "prostm/pipeline/runner.hpp"

namespace prostm {
namespace {

constexpr Quantity<RunSummary> count(const char* name, std::int64_t RunSummary::*number,
                                     const char* help, Better better = Better::Neither) {
  return {.name = name, .unit = "", .help = help, .value = number, .better = better};
}

double rate(std::int64_t count, const RunSummary& s) {
  return s.seconds > 0.0 ? static_cast<double>(count) / s.seconds : 0.0;
}
double world_rate(const RunSummary& s) {
  return rate(s.world_steps, s);
}
double plan_rate(const RunSummary& s) {
  return rate(s.plans + s.empty_updates, s);
}

constexpr std::array kStats{
    Quantity<RunSummary>{
        .name = "seconds", .unit = "s", .help = "Run time.", .value = &RunSummary::seconds},
    Quantity<RunSummary>{.name = "took_seconds",
                         .unit = "s",
                         .help = "Elapsed time, including pauses.",
                         .value = &RunSummary::took},
    count("world_steps", &RunSummary::world_steps, "Steps of the world."),
    count("skipped_world_steps", &RunSummary::skipped_world_steps,
          "Steps skipped because the machine was more than one step behind.", Better::Less),
    Quantity<RunSummary>{
        .name = "world_rate_hz", .unit = "Hz", .help = "Steps per second.", .value = &world_rate},
    count("plans", &RunSummary::plans, "Updates with a plan."),
    count("empty_updates", &RunSummary::empty_updates, "Updates without pressure."),
    count("skipped_updates", &RunSummary::skipped_updates,
          "Targets that a newer one replaced before they were planned.", Better::Less),
    Quantity<RunSummary>{
        .name = "plan_rate_hz", .unit = "Hz", .help = "Updates per second.", .value = &plan_rate},
    count("judged_updates", &RunSummary::judged_updates,
          "Updates whose target should be a stimulus."),
    count("passed_updates", &RunSummary::passed_updates, "Of these, those that passed its gate.",
          Better::More),
    count("late_page_hands", &RunSummary::late_page_hands,
          "Releases of the page's hand because its messages came late.", Better::Less),
    count("hidden_page_hands", &RunSummary::hidden_page_hands,
          "Releases of the page's hand because its page was hidden.", Better::Less),
    count("held_updates", &RunSummary::held_updates,
          "Updates of a hand that had been held well for 5 s."),
    count("held_passed_updates", &RunSummary::held_passed_updates,
          "Of these, those that passed the gate.", Better::More),
    count("unrecorded", &RunSummary::unobserved,
          "Updates dropped because the recording was too slow.", Better::Less),
    count("long_paths", &RunSummary::long_paths, "Paths longer than the limit.", Better::Less),
    count("crossings", &RunSummary::crossings, "Pairs of segments that cross.", Better::Less),
    Quantity<RunSummary>{.name = "max_path_length_mm",
                         .unit = "mm",
                         .help = "Length of the longest path in its plane.",
                         .value = &RunSummary::max_path_length,
                         .merge = Merge::Most,
                         .scale = 1e3},
    Quantity<RunSummary>{.name = "max_skin_length_mm",
                         .unit = "mm",
                         .help = "Length of the longest path on the skin.",
                         .value = &RunSummary::max_skin_length,
                         .merge = Merge::Most,
                         .scale = 1e3},
    Quantity<RunSummary>{.name = "full_scale_pressure_pa",
                         .unit = "Pa",
                         .help = "Rendered pressure at intensity 1.",
                         .value = &RunSummary::full_scale_pressure,
                         .merge = Merge::Newest},
    count("limited_samples", &RunSummary::limited_samples,
          "Samples changed by the limiter because of an error in a stage.", Better::Less),
    count("world_resets", &RunSummary::world_resets,
          "Steps after which the world restarted because a number was not finite.", Better::Less),
};

constexpr std::array<StageSummary, 6> kStages{{{"track", &RunSummary::track},
                                               {"hand", &RunSummary::hand},
                                               {"world", &RunSummary::world},
                                               {"contact", &RunSummary::contact},
                                               {"plan", &RunSummary::plan},
                                               {"lift", &RunSummary::lift}}};

}  // namespace

template <>
std::span<const Quantity<RunSummary>> quantities<RunSummary>() {
  return kStats;
}

std::span<const StageSummary> stage_summaries() {
  return kStages;
}

}  // namespace prostm
