#include "prostm/pipeline/realtime/advice.hpp"

#include <fmt/format.h>

#include "prostm/pipeline/smoke/scene.hpp"
#include "prostm/pipeline/smoke/scene_grids.hpp"
#include "prostm/pipeline/smoke/smoke_world.hpp"

namespace prostm {
namespace {

// Largest share of the available time. The rest is left for other stages, for waking threads, and
// for other programs.
constexpr double kBusy = 0.8;
constexpr double kComfortable = 0.6;  // the same for a recommended setting

constexpr const char* kOtherwise = "close other programs, or use a faster machine";

/// Whether a step at `cells` comfortably fits into its time. The work is proportional to the number
/// of cells.
bool fits(int cells, const WorkTime& work, const PipelineSettings& settings) {
  const double edge = static_cast<double>(cells) / settings.fluid.cells;
  return work.step * edge * edge * edge <= kComfortable / settings.world_rate;
}

/// The finest coarser grid that fits and is not known to lose the stimulus.
Advice coarser_grid(const WorkTime& work, const PipelineSettings& settings) {
  if (!is_smoke(settings)) return {AdviceKind::NoOption};
  for (const int cells : coarser_grids(settings.scene, settings.fluid.cells)) {
    if (!fits(cells, work, settings)) continue;
    const bool known = grid_effect(settings, cells) == GridEffect::Keeps;
    return {known ? AdviceKind::Grid : AdviceKind::UnknownGrid, cells};
  }
  return {AdviceKind::NoOption};
}

Advice less_to_plan(const PipelineSettings& settings) {
  const bool of_paths = settings.method == Method::ProStm;
  if (of_paths && settings.plan.preset != kCheapestPreset) return {AdviceKind::FastPreset};
  const int paths = of_paths ? settings.plan.paths : settings.am.foci;
  return {paths > 1 ? AdviceKind::FewerPaths : AdviceKind::NoOption};
}

/// Whether parts of the pressure are computed only for recording.
bool computes_parts(const PipelineSettings& settings) {
  return is_smoke(settings) && settings.fluid_pressure.parts &&
         settings.fluid_pressure.part == PressurePart::All;
}

/// Whether a coarser grid may lose the scene's stimulus.
bool has_stimulus(const PipelineSettings& settings) {
  return is_smoke(settings) && scene_from_name(settings.scene).stimulus.maxima > 0;
}

std::string grid_sentence(const Advice& advice, const PipelineSettings& settings) {
  const bool stimulus = has_stimulus(settings);
  const std::string use =
      fmt::format("--grid {}{}", advice.cells,
                  stimulus ? fmt::format(", which keeps the stimulus of {}", settings.scene) : "");
  // other programs are the cause; a coarser grid leaves them more time
  if (advice.cause == Busy::Neither) return fmt::format("Close other programs, or use {}.", use);
  return fmt::format("Use {}, or close other programs.", use);
}

std::string no_option_sentence(const Advice& advice, const PipelineSettings& settings) {
  if (advice.cause == Busy::Neither) return "Close other programs.";
  const bool stimulus = has_stimulus(settings);
  if (advice.cause == Busy::Plan || !stimulus)
    return fmt::format("No option is fast enough: {}.", kOtherwise);
  return fmt::format("No option is fast enough and keeps the stimulus of {}: {}.", settings.scene,
                     kOtherwise);
}

}  // namespace

Busy busy(const WorkTime& work, const PipelineSettings& settings) {
  const double due = 1.0 / settings.world_rate;
  if (work.step > kBusy * due) return Busy::Step;
  return work.plan > kBusy * due * settings.steps_per_plan() ? Busy::Plan : Busy::Neither;
}

Advice advise(const WorkTime& work, const PipelineSettings& settings) {
  const Busy cause = busy(work, settings);
  Advice advice = cause == Busy::Plan        ? less_to_plan(settings)
                  : computes_parts(settings) ? Advice{AdviceKind::OneField}
                                             : coarser_grid(work, settings);
  advice.cause = cause;
  return advice;
}

std::string sentence(const Advice& advice, const PipelineSettings& settings) {
  switch (advice.kind) {
    case AdviceKind::None:
      return {};
    case AdviceKind::OneField:
      return "Set parts = false in [contact], which halves the smoke's work, or close other "
             "programs.";
    case AdviceKind::Grid:
      return grid_sentence(advice, settings);
    case AdviceKind::UnknownGrid:
      return fmt::format(
          "Close other programs, or use a faster machine. --grid {} would be fast enough, but its "
          "effect on the stimulus is not known with these settings: measure it with --hand study "
          "--as-fast-as-possible.",
          advice.cells);
    case AdviceKind::FastPreset:
      return "Use --preset fast.";
    case AdviceKind::FewerPaths:
      return "Use fewer --paths.";
    case AdviceKind::NoOption:
      break;
  }
  return no_option_sentence(advice, settings);
}

Adviser::Key Adviser::key_of(const PipelineSettings& settings) {
  const bool of_paths = settings.method == Method::ProStm;
  return {settings.world + '/' + settings.scene,
          settings.fluid,
          computes_parts(settings),
          settings.method,
          settings.plan.preset,
          of_paths ? settings.plan.paths : settings.am.foci,
          settings.world_rate};
}

const Advice& Adviser::advise(const WorkTime& work, const PipelineSettings& settings) {
  if (!is_for(settings)) {
    key_ = key_of(settings);
    given_ = {};
  }
  const Advice now = prostm::advise(work, settings);
  Advice& given = given_[now.cause == Busy::Plan ? 1 : 0];
  if (given.kind == AdviceKind::None) given = now;
  given.cause = now.cause;
  return given;
}

}  // namespace prostm
