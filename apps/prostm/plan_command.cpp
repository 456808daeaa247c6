#include <fmt/format.h>

#include "common.hpp"
#include "core/input_error.hpp"
#include "figure/figures.hpp"
#include "io/field_file.hpp"
#include "io/file.hpp"
#include "io/plan_file.hpp"
#include "plan/planner.hpp"
#include "plan/quasi_static.hpp"
#include "score/score.hpp"

namespace prostm::app {
namespace {

void print_plan(std::FILE* out, const Plan& plan, const PlanStats& stats, const Metrics& metrics,
                const std::vector<Control>& controls) {
  fmt::print(out, "{} clusters, {} leaves, {} paths; {} too long, {} crossings; {:.2f} ms\n",
             stats.clusters, stats.leaves, plan.paths.size(), stats.long_paths, stats.crossings,
             stats.total * 1e3);
  for (std::size_t i = 0; i < plan.paths.size(); ++i) {
    const FocalPath& path = plan.paths[i];
    fmt::print(out, "  path {}: {:.1f} mm, {:.1f} ms, {} points\n", i + 1, path.length * 1e3,
               path.period * 1e3, path.points.size());
  }
  const auto row = [&](const std::string& name, const Metrics& m) {
    fmt::print(out, "  {:<26} {:>7.3f} {:>7.3f} {:>7.3f} {:>7.3f} {:>7.3f} {:>7.3f} {:>7.3f}\n",
               name, m.rmse, m.correlation, m.coverage, m.skill_0, m.skill_8, m.overlap, m.spill);
  };
  fmt::print(out, "  {:<26} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7}\n", "", "RMSE", "corr",
             "cover", "S_0", "S_8.5", "overlap", "spill");
  row("this plan", metrics);
  for (const Control& control : controls) row("control: " + control.name, control.metrics);
}

}  // namespace

int plan_command(const PlanOptionsGiven& given) {
  PipelineSettings settings = make_settings(given.common, std::nullopt);
  FieldFileOptions file_options;
  file_options.cell_mm = given.cell_mm;
  file_options.frame = given.frame;
  const TargetField target = read_field(given.field, file_options);

  Planner planner(settings.plan, target.size());
  Plan plan;
  PlanStats stats;
  PlanTrace trace;
  const PlanStatus status = planner.plan(target, plan, stats);
  if (status == PlanStatus::InvalidTarget) {
    throw InputError(
        given.field +
        ": the field has a value that cannot be planned; pressures must be finite and >= 0");
  }
  // a second time with the intermediate results, so that collecting them is not in the times
  if (!given.common.figure.empty()) {
    PlanStats traced;
    planner.plan(target, plan, traced, &trace);
  }
  const PlanSettings& s = settings.plan;
  const Metrics metrics = score_plan(target, plan, 0, s.sigma, s.gain);
  std::vector<Control> control_rows;
  if (status == PlanStatus::Planned) {
    control_rows = controls(target, s.sigma, s.gain, s.max_length, nullptr,
                            static_cast<std::uint64_t>(s.seed));
  }

  if (status == PlanStatus::EmptyTarget) {
    fmt::print(prose(given.common.json), "{}: no pressure anywhere, so no path\n", given.field);
  } else {
    print_plan(prose(given.common.json), plan, stats, metrics, control_rows);
  }
  if (!given.common.json.empty()) {
    PlanFileExtras extras;
    extras.stats = &stats;
    extras.metrics = &metrics;
    extras.controls = &control_rows;
    write_file(given.common.json, plan_to_json(plan, target, s, extras, settings_json(settings)));
  }
  if (!given.common.figure.empty()) {
    PlanFigure figure;
    figure.target = &target;
    figure.plan = &plan;
    figure.trace = &trace;
    figure.reconstruction.resize(target.size());
    quasi_static_field(plan, 0, target, s.sigma, s.gain, figure.reconstruction);
    figure.metrics = metrics;
    figure.controls = control_rows;
    figure.title = given.field + ", preset " + s.preset;
    draw_plan(figure, given.common.figure);
  }
  return 0;
}

}  // namespace prostm::app
