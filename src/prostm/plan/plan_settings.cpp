#include "prostm/plan/plan_settings.hpp"

#include <stdexcept>
#include <string>

#include "prostm/core/require.hpp"
#include "prostm/plan/clustering.hpp"
#include "prostm/plan/plan.hpp"

namespace prostm {

Preset preset_from_name(const std::string& name) {
  if (name == "paper") return Preset::Paper;
  if (name == "paper-valid") return Preset::PaperValid;
  if (name == "best") return Preset::Best;
  if (name == "fast") return Preset::Fast;
  throw std::invalid_argument("preset '" + name +
                              "' is unknown: it must be best, fast, paper or paper-valid");
}

std::string to_string(Preset preset) {
  switch (preset) {
    case Preset::Paper:
      return "paper";
    case Preset::PaperValid:
      return "paper-valid";
    case Preset::Best:
      return "best";
    case Preset::Fast:
      break;
  }
  return "fast";
}

void PlanSettings::visit(SettingsVisitor& v) {
  v.field("preset", preset);
  v.field("paths", paths);
  v.field("clusters", clusters);
  v.field("samples", samples);
  v.field("speed", speed);
  v.field("draw_rate", draw_rate);
  v.field("sigma", sigma);
  v.field("gain", gain);
  v.field("gain_exponent", gain_exponent);
  v.field("weight_pressure", weight_pressure);
  v.field("weight_length", weight_length);
  v.field("weight_intersection", weight_intersection);
  v.field("weight_bending", weight_bending);
  v.field("weak_pressure", weak_pressure);
  v.field("lloyd_iterations", lloyd_iterations);
  v.field("refine_iterations", refine_iterations);
  v.field("seed", seed);
  v.field("least_length", least_length);
  v.field("fit_coverage", fit_coverage);
  v.field("fit_length", fit_length);
  v.field("fit_spacing", fit_spacing);
  v.field("fit_bending", fit_bending);
  v.field("fit_samples", fit_samples);
  v.field("fit_hysteresis", fit_hysteresis);
  v.field("fit_starts", fit_starts);
  v.field("fit_kicks", fit_kicks);
  v.field("budget", budget);
  v.field("full_scale_pressure", full_scale_pressure);
}

double PlanSettings::sigma_on(const TargetField& target) const {
  const Preset kind = preset_from_name(preset);
  const bool by_place = (kind == Preset::Best || kind == Preset::Fast) && !widths.empty();
  return by_place ? widths.on(target) : sigma;
}

void validate(const PlanSettings& s) {
  preset_from_name(s.preset);
  require_between("paths", s.paths, 1, kMaxPaths);
  require_between("clusters", s.clusters, 1, planning::kMaxClusters);
  require_between("samples", s.samples, 8, kMaxPathPoints);
  require_between("speed", s.speed, 0.1, 100.0, "m/s");
  require_between("draw_rate", s.draw_rate, 0.1, 10'000.0, "Hz");
  require_between("speed / draw_rate", s.max_length(), 0.01, 1.0, "m");
  require_between("sigma", s.sigma, 1e-4, 0.1, "m");
  validate(s.widths);
  require_between("gain", s.gain, 0.01, 100.0);
  require_between("gain_exponent", s.gain_exponent, -2.0, 2.0);
  require_between("weight_pressure", s.weight_pressure, 0.0, 1000.0);
  require_between("weight_length", s.weight_length, 0.0, 1000.0);
  require_between("weight_intersection", s.weight_intersection, 0.0, 1000.0);
  require_between("weight_bending", s.weight_bending, 0.0, 1000.0);
  require_between("weak_pressure", s.weak_pressure, 0.0001, 1.0);
  require_between("lloyd_iterations", s.lloyd_iterations, 1, 10000);
  require_between("refine_iterations", s.refine_iterations, 0, 100000);
  require_between("least_length", s.least_length, 0.005, 1.0, "m");
  require_between("fit_coverage", s.fit_coverage, 0.0, 100.0);
  require_between("fit_length", s.fit_length, 0.0, 1000.0);
  require_between("fit_spacing", s.fit_spacing, 0.0, 1000.0);
  require_between("fit_bending", s.fit_bending, 0.0, 1000.0);
  require_between("fit_samples", s.fit_samples, 8, kMaxPathPoints);
  require_between("fit_hysteresis", s.fit_hysteresis, 0.0, 1.0);
  require_between("fit_starts", s.fit_starts, 1, 10000);
  require_between("fit_kicks", s.fit_kicks, 0, 100000);
  require_between("budget", s.budget, 0.0, 60.0, "s");
  require_between("full_scale_pressure", s.full_scale_pressure, 0.0, 1e300);
  require_between("rise_time", s.rise_time, 1e-6, 1.0, "s");
  require_between("silent_below", s.silent_below, 0.0, 1.0);
  if (s.budget > 0.0 && preset_from_name(s.preset) != Preset::Best) {
    throw std::invalid_argument("a budget is for preset best, not " + s.preset);
  }
}

}  // namespace prostm
