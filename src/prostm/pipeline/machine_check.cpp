#include "prostm/pipeline/machine_check.hpp"

#include <fmt/format.h>

#include <array>

namespace prostm {
namespace {

constexpr std::array<CheckedSetup, 5> kSetups{{{FluidSettings{}.cells, Preset::Best},
                                               {FluidSettings{}.cells, Preset::Fast},
                                               {48, Preset::Best},
                                               {32, Preset::Best},
                                               {32, Preset::Fast}}};

/// How much time the stages leave.
std::string slack(const RunSummary& s) {
  const PipelineSettings settings;
  const double step = 1e3 / settings.world_rate;
  return fmt::format(
      "Slack: a step of the smoke takes {:.1f} ms at the median and {:.1f} ms at the 99th "
      "percentile, of {:.0f}; a plan takes {:.1f} and {:.1f} ms, of {:.0f}.",
      1e3 * s.world.p50, 1e3 * s.world.p99, step, 1e3 * s.plan.p50, 1e3 * s.plan.p99,
      step * settings.steps_per_plan());
}

}  // namespace

std::span<const CheckedSetup> checked_setups() {
  return kSetups;
}

std::string options_of(const CheckedSetup& setup) {
  return fmt::format("--grid {} --preset {}", setup.cells, name_of(setup.preset));
}

MachineAnswer answer_of(std::span<const Trial> trials) {
  MachineAnswer answer;
  if (trials.empty()) {
    answer.sentences.emplace_back("Nothing was tried: the machine was too slow to begin.");
    return answer;
  }
  const Trial &first = trials.front(), &last = trials.back();
  const PipelineSettings settings;
  const std::string rates =
      fmt::format("{:.0f} steps and {:.0f} plans a second", settings.world_rate,
                  settings.world_rate / settings.steps_per_plan());
  answer.defaults_hold = first.holds();
  if (last.holds()) answer.use = last.setup;
  if (answer.defaults_hold) {
    answer.sentences.push_back(fmt::format("This machine holds {} with the defaults ({}).", rates,
                                           options_of(first.setup)));
  } else if (answer.use) {
    answer.sentences.push_back(
        fmt::format("This machine does not hold {} with the defaults, but it does with {}: use "
                    "these options.",
                    rates, options_of(*answer.use)));
  } else {
    answer.sentences.push_back(
        fmt::format("This machine does not hold {}, not even with {}: close what else runs and "
                    "check again, or run without a clock (--as-fast-as-possible).",
                    rates, options_of(last.setup)));
  }
  if (answer.use) answer.sentences.push_back(slack(last.summary));
  return answer;
}

}  // namespace prostm
