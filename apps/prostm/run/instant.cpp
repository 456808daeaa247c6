#include "run/instant.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "prostm/emit/played.hpp"
#include "prostm/figure/figures.hpp"
#include "prostm/plan/lifted_plan.hpp"
#include "prostm/plan/quasi_static/quasi_static.hpp"

namespace prostm::app {

void draw_instant(const WorldFrame& contact, const PlanFrame& planned,
                  const PipelineSettings& settings, const std::string& path) {
  const GridShape& grid = contact.side.grid;
  SceneFigure figure;
  figure.nx = grid.nx;
  figure.nz = grid.nz;
  figure.cell = grid.cell;
  figure.origin = grid.p_DF({0, 2}) + Vec2::Constant(0.5 * grid.cell);
  figure.smoke = contact.side.density;
  figure.hand = contact.side.hand;
  for (const Vec3& p : settings.transducers.position) figure.array.emplace_back(p.x(), p.z());
  LiftedPlan lifted;
  lift(planned.plan, contact.target, lifted);
  for (const LiftedPath& lifted_path : lifted.paths) {
    figure.foci.insert(figure.foci.end(), lifted_path.p_D.begin(), lifted_path.p_D.end());
  }
  for (const LiftedFocus& focus : lifted.foci) figure.foci.push_back(focus.p_D);
  EmitSettings emit = settings.emit;
  emit.full_scale_pressure = planned.full_scale_pressure;
  const double rate = planned.emission_rate;
  const SegmentPressures played = played_pressures(planned.plan, contact.target, emit, rate);
  const PlanSettings plan = plan_settings(settings, rate);
  std::vector<std::string> widths;  // of a focal point on each patch [mm]
  for (std::size_t patch = 0; patch < contact.target.patches.size(); ++patch) {
    const TargetField& target = contact.target.patches[patch];
    const double sigma = settings.method == Method::Am ? settings.am.sigma : plan.sigma_on(target);
    widths.push_back(fmt::format("{:.1f}", 1e3 * sigma));
    std::vector<double> field(target.size());
    quasi_static_field(planned.plan, static_cast<int>(patch), target, sigma,
                       settings.plan.gain_law(), field, &played);
    figure.targets.push_back(target);
    figure.reconstructions.push_back(std::move(field));
  }
  figure.plan = planned.plan;
  figure.title = fmt::format("{} at {:.2f} s", settings.scene, contact.target.time);
  if (!widths.empty())
    figure.title += fmt::format("; focal points with σ = {} mm", fmt::join(widths, " and "));
  draw_scene(figure, path);
}

}  // namespace prostm::app
