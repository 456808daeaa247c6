#include <cmath>
#include <stdexcept>
#include <string>

#include "plan/clustering.hpp"
#include "plan/planner.hpp"
#include "plan/settings_check.hpp"

namespace prostm {

Preset preset_from_name(const std::string& name) {
  if (name == "paper") return Preset::Paper;
  if (name == "paper-valid") return Preset::PaperValid;
  if (name == "best" || name == "fast") {
    throw std::invalid_argument("preset '" + name +
                                "' is not built yet: it must be paper or paper-valid");
  }
  throw std::invalid_argument("preset '" + name + "' is unknown: it must be paper or paper-valid");
}

std::string to_string(Preset preset) {
  return preset == Preset::Paper ? "paper" : "paper-valid";
}

void PlanSettings::visit(SettingsVisitor& v) {
  v.field("preset", preset);
  v.field("paths", paths);
  v.field("clusters", clusters);
  v.field("samples", samples);
  v.field("max_length", max_length);
  v.field("speed", speed);
  v.field("sigma", sigma);
  v.field("gain", gain);
  v.field("weight_pressure", weight_pressure);
  v.field("weight_length", weight_length);
  v.field("weight_intersection", weight_intersection);
  v.field("weight_bending", weight_bending);
  v.field("weak_pressure", weak_pressure);
  v.field("lloyd_iterations", lloyd_iterations);
  v.field("refine_iterations", refine_iterations);
  v.field("seed", seed);
}

namespace planning {
namespace {

std::string number(double value) {
  std::string text = std::to_string(value);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text;
}

void check(const char* name, double value, double low, double high, const char* unit) {
  if (std::isfinite(value) && value >= low && value <= high) return;
  throw std::invalid_argument(std::string(name) + " = " + number(value) + unit +
                              " must be between " + number(low) + " and " + number(high) + unit);
}

void check(const char* name, int value, int low, int high) {
  if (value >= low && value <= high) return;
  throw std::invalid_argument(std::string(name) + " = " + std::to_string(value) +
                              " must be between " + std::to_string(low) + " and " +
                              std::to_string(high));
}

}  // namespace

void check_settings(const PlanSettings& s) {
  preset_from_name(s.preset);
  check("paths", s.paths, 1, kMaxPaths);
  check("clusters", s.clusters, 1, kMaxClusters);
  check("samples", s.samples, 8, kMaxPathPoints);
  check("max_length", s.max_length, 0.01, 1.0, " m");
  check("speed", s.speed, 0.1, 100.0, " m/s");
  check("sigma", s.sigma, 1e-4, 0.1, " m");
  check("gain", s.gain, 0.01, 100.0, "");
  check("weight_pressure", s.weight_pressure, 0.0, 1000.0, "");
  check("weight_length", s.weight_length, 0.0, 1000.0, "");
  check("weight_intersection", s.weight_intersection, 0.0, 1000.0, "");
  check("weight_bending", s.weight_bending, 0.0, 1000.0, "");
  check("weak_pressure", s.weak_pressure, 0.0001, 1.0, "");
  check("lloyd_iterations", s.lloyd_iterations, 1, 10000);
  check("refine_iterations", s.refine_iterations, 0, 100000);
}

}  // namespace planning
}  // namespace prostm
