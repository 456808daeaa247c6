#include "prostm/plan/plan_settings.hpp"

#include <limits>
#include <stdexcept>
#include <string>

#include "prostm/core/require.hpp"
#include "prostm/plan/clustering.hpp"
#include "prostm/plan/plan.hpp"

namespace prostm {

namespace {

/// Lists the settings of presets best, fast and felt.
template <class Settings, class Visitor>
void list_fit(Settings& s, Visitor& v) {
  constexpr double kPoints = kMaxPathPoints;
  v.field({"least_length", "m", 0.005, 1, "least length of a path of presets best, fast and felt"},
          s.least_length);
  v.field({"fit_coverage", "", 0, 100, "weight of pressure that no path reaches"}, s.fit_coverage);
  v.field({"fit_length", "", 0, 1000, "weight of length and uneven points"}, s.fit_length);
  v.field({"fit_spacing", "", 0, 1000, "weight of points that are too near"}, s.fit_spacing);
  v.field({"fit_bending", "", 0, 1000, "weight of bends"}, s.fit_bending);
  v.field({"strength_weight", "", 0, 10,
           "preset felt: weight of a stronger percept against a truer shape; 0: shape alone"},
          s.strength_weight);
  v.field({"fit_samples", "", 8, kPoints,
           "points per path in the search of preset best; plans have twice as many, up to 64"},
          s.fit_samples);
  v.field({"fit_hysteresis", "", 0, 1, "share of the cost that new paths must save"},
          s.fit_hysteresis);
  v.field({"fit_starts", "", 1, 10'000, "sets of paths tried if there is no previous plan"},
          s.fit_starts);
  v.field({"fit_kicks", "", 0, 100'000, "attempts to re-initialise one or two paths"}, s.fit_kicks);
  v.field({"budget", "s", 0, 60,
           "time after which best and felt try nothing more; 0: only counts apply"},
          s.budget);
  v.field({"full_scale_pressure", "", 0, 1e300,
           "rendered pressure at full output that best, "
           "fast and felt assume; 0: gain times the largest"},
          s.full_scale_pressure);
}

template <class Settings, class Visitor>
void list(Settings& s, Visitor& v) {
  constexpr int kSeeds = std::numeric_limits<int>::max();
  constexpr double kMostClusters = planning::kMaxClusters, kPoints = kMaxPathPoints;
  v.field({.name = "preset", .help = "how paths are planned"}, s.preset);
  v.field({"paths", "", 1, kMaxPaths, "largest number of paths"}, s.paths);
  v.field({"clusters", "", 1, kMostClusters, "k of the weighted k-means"}, s.clusters);
  v.field({"samples", "", 8, kPoints, "points per path (N); preset best uses fit_samples"},
          s.samples);
  v.field({"speed", "m/s", 0.1, kMaxFocusSpeed, "speed of the focal points (v)"}, s.speed);
  v.field({"draw_rate", "Hz", 0.1, 1e4, "laps per second of the longest path"}, s.draw_rate);
  v.field({"sigma", "m", 1e-4, 0.1, "fall-off of a focal point in Eqs. (1) and (4)"}, s.sigma);
  v.field({"gain", "", 0.01, 100, "gamma of the longest path: rendered over effective pressure"},
          s.gain);
  v.field({"gain_exponent", "", -2, 2,
           "exponent of a path's period in its gamma; 0: one gamma for all"},
          s.gain_exponent);
  v.field({.name = "gain_from_skin",
           .help = "gamma by period from the skin model, instead of gain_exponent"},
          s.gain_from_skin);
  v.field({"weight_pressure", "", 0, 1000, "weight of Eq. (2), the pressure on a path"},
          s.weight_pressure);
  v.field({"weight_length", "", 0, 1000, "weight of Eq. (3), the length of a path"},
          s.weight_length);
  v.field({"weight_intersection", "", 0, 1000, "weight of Eq. (4), paths near each other"},
          s.weight_intersection);
  v.field({"weight_bending", "", 0, 1000, "weight of Eq. (5), bends"}, s.weight_bending);
  v.field({"weak_pressure", "", 1e-4, 1,
           "share of the largest pressure below which no point is "
           "clustered"},
          s.weak_pressure);
  v.field({"lloyd_iterations", "", 1, 10'000, "largest number of iterations of the k-means"},
          s.lloyd_iterations);
  v.field({"refine_iterations", "", 0, 100'000, "largest number of gradient steps"},
          s.refine_iterations);
  v.field({"seed", "", 0, kSeeds, "seed of the planner's random choices"}, s.seed);
  list_fit(s, v);
}

}  // namespace

void PlanSettings::visit(SettingsReader& v) const {
  list(*this, v);
}
void PlanSettings::visit(SettingsWriter& v) {
  list(*this, v);
  constexpr const char* kFelt = "preset \"felt\"";
  const bool weight = v.replaced({"felt_weight", "", 0, 1, kFelt});
  const bool points = v.replaced({.name = "felt_points", .help = kFelt});
  if (!weight && !points) return;
  if (!traits().is_fitted()) {
    throw std::invalid_argument(std::string(weight ? "felt_weight" : "felt_points") +
                                " selects preset felt, but the preset is " +
                                std::string(traits().name) + ": remove one of them");
  }
  preset = Preset::Felt;
}

double PlanSettings::sigma_on(const TargetField& target) const {
  return traits().is_fitted() && !widths.empty() ? widths.on(target) : sigma;
}

void validate(const PlanSettings& s) {
  require_bounds(s);
  require_between("speed / draw_rate", s.max_length(), 0.01, 1.0, "m");
  require_between("rise_time", s.rise_time, 1e-6, 1.0, "s");
  require_between("silent_below", s.silent_below, 0.0, 1.0);
  validate(s.widths);
  if (s.gain_from_skin && s.gain_exponent != 0.0) {
    throw std::invalid_argument(
        "gain_from_skin replaces gain_exponent: with it, gain_exponent must be 0");
  }
  const PresetTraits& traits = s.traits();
  if (s.budget > 0.0 && !traits.takes_budget()) {
    throw std::invalid_argument(
        "a budget is for " + presets_with([](const PresetTraits& t) { return t.takes_budget(); }) +
        ", not " + std::string(traits.name));
  }
  if (s.budget > 0.0 && s.felt_points) {
    throw std::invalid_argument(
        "felt_points takes tenths of a second per plan, so it cannot be combined with a budget, "
        "which real-time runs have");
  }
  // a loop may be as short as half a lap of the longest path, and must satisfy is_loop()
  if (s.felt_weight > 0.0)
    require_between("draw_rate with felt_weight", s.draw_rate, 1.0, 500.0, "Hz");
  if (traits.chooses_by_percept)
    require_between("draw_rate with preset felt", s.draw_rate, 1.0, 500.0, "Hz");
  if (s.felt_weight > 0.0 && !traits.takes_felt_weight()) {
    throw std::invalid_argument("felt_weight is for " + presets_with([](const PresetTraits& t) {
                                  return t.takes_felt_weight();
                                }) +
                                ", not " + std::string(traits.name));
  }
}

}  // namespace prostm
