#include "plan/plan_pictures.hpp"

#include "prostm/plan/quasi_static/quasi_static.hpp"

namespace prostm::app {

SegmentPressures played(const TargetField& target, const Plan& plan,
                        const PipelineSettings& settings) {
  if (plan.empty()) return {};
  return played_pressures(plan, target, emit_settings(settings, max_pressure(target)),
                          settings.emission_rate());
}

PlanFigure as_figure(const TargetField& target, const Plan& plan, const PlanTrace& trace,
                     const PipelineSettings& settings) {
  PlanFigure figure;
  figure.target = &target;
  figure.plan = &plan;
  figure.trace = &trace;
  figure.reconstruction.resize(target.size());
  const SegmentPressures pressures = played(target, plan, settings);
  quasi_static_field(plan, 0, target, settings.sigma(), settings.plan.gain_law(),
                     figure.reconstruction, &pressures);
  return figure;
}

PlanFigure as_figure(const TargetField& target, const DigitisedFigure& digitised,
                     const PipelineSettings& settings, const std::string& title) {
  const PlanSettings& s = settings.plan;
  PlanFigure figure = as_figure(target, digitised.plan, digitised.trace, settings);
  figure.reconstruction = digitised.reconstruction;
  const SegmentPressures pressures = played(target, digitised.plan, settings);
  figure.metrics = score_plan(target, digitised.plan, 0, s.sigma, s.gain_law(), &pressures);
  figure.title = title;
  return figure;
}

}  // namespace prostm::app
