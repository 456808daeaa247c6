#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "common.hpp"
#include "field/field_words.hpp"
#include "field/quality_words.hpp"
#include "plan/fewer_paths.hpp"
#include "plan/plan_pictures.hpp"
#include "prostm/am/am_planner.hpp"
#include "prostm/commit.hpp"
#include "prostm/core/file/file.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/random.hpp"
#include "prostm/emit/emitter.hpp"
#include "prostm/emit/played.hpp"
#include "prostm/emit/played_plan.hpp"
#include "prostm/figure/figures.hpp"
#include "prostm/io/digitised_figure.hpp"
#include "prostm/io/field/field_file.hpp"
#include "prostm/io/plan_file.hpp"
#include "prostm/pipeline/playable.hpp"
#include "prostm/plan/planner.hpp"
#include "prostm/plan/quasi_static/quasi_static.hpp"
#include "prostm/score/physical.hpp"
#include "prostm/score/pooled.hpp"
#include "prostm/score/score.hpp"

namespace prostm::app {
namespace {

bool is_am(const PipelineSettings& settings) {
  return settings.method == Method::Am;
}

void print_foci(std::FILE* out, const Plan& plan, const PlanStats& stats, double maximum,
                const std::string& felt) {
  fmt::print(out, "{} foci, {} iterations of k-means; {:.3f} ms\n", plan.foci.size(),
             stats.lloyd_iterations, 1e3 * stats.total);
  if (!felt.empty()) fmt::print(out, "  {}\n", felt);
  for (std::size_t i = 0; i < plan.foci.size(); ++i) {
    const FocalPoint& focus = plan.foci[i];
    const std::string phase =
        focus.phase > 0.0 ? fmt::format(", {:.0f} % of a period late", 100.0 * focus.phase) : "";
    fmt::print(out, "  focus {}: at ({:.1f}, {:.1f}) mm, {:.3f} of the target's maximum{}\n", i + 1,
               focus.position.x() * 1e3, focus.position.y() * 1e3, focus.pressure / maximum, phase);
  }
}

void print_paths(std::FILE* out, const Plan& plan, const PlayedPlan& played, const PlanStats& stats,
                 const std::string& felt) {
  const std::string work = stats.clusters > 0
                               ? fmt::format("{} clusters, {} leaves", stats.clusters, stats.leaves)
                               : fmt::format("{} evaluations of the field", stats.cost_evaluations);
  const std::size_t paths = plan.paths.size();
  fmt::print(out, "{} path{} in {:.2f} ms ({}); {} too long, {} crossings\n", paths,
             paths == 1 ? "" : "s", 1e3 * stats.total, work, stats.long_paths, stats.crossings);
  if (!felt.empty()) {
    fmt::print(out, "  in step: all paths come round together every {:.1f} ms; {}\n",
               1e3 * plan.loop, felt);
  }
  for (std::size_t i = 0; i < plan.paths.size(); ++i) {
    const FocalPath& path = plan.paths[i];
    const double period = played.paths[i].laps > 0 ? played.paths[i].period : path.period;
    fmt::print(out, "  path {}: {:.1f} mm, {:.1f} ms, {:.1f} Hz, {} points\n", i + 1,
               path.length * 1e3, period * 1e3, 1.0 / period, path.points.size());
  }
}

void print_quality(std::FILE* out, const PlanQuality& quality,
                   const std::vector<Control>& controls) {
  fmt::print(out, "  quality of what is played, by Eq. (1) with sigma {:.2f} mm:\n",
             1e3 * quality.sigma);
  std::vector<MetricsRow> rows;
  rows.emplace_back("this plan", quality.played);
  for (const PlanQuality::At& at : quality.at) {
    rows.emplace_back(fmt::format("this plan, sigma {:.2f} mm", 1e3 * at.sigma), at.played);
  }
  for (const Control& control : controls)
    rows.emplace_back("control: " + control.name, control.metrics);
  print_metrics(out, "", rows);
}

/// Another target on the same skin, for the control that plays the paths of one: three blobs at
/// random places.
TargetField another_target(const TargetField& target, std::uint64_t seed) {
  constexpr double kWidth = 0.020;  // [m]
  std::vector<std::size_t> skin;
  for (std::size_t c = 0; c < target.size(); ++c) {
    if (target.skin[c] != 0) skin.push_back(c);
  }
  Random random(seed);
  TargetField other = target;
  std::fill(other.pressure.begin(), other.pressure.end(), 0.0);
  const auto position = [&](std::size_t c) {
    const auto cols = static_cast<std::size_t>(target.cols);
    return target.position(static_cast<int>(c / cols), static_cast<int>(c % cols));
  };
  for (int blob = 0; blob < 3; ++blob) {
    const Vec2 centre =
        position(skin[static_cast<std::size_t>(random.below(static_cast<int>(skin.size())))]);
    for (const std::size_t c : skin) {
      other.pressure[c] +=
          std::exp(-(position(c) - centre).squaredNorm() / (2.0 * kWidth * kWidth));
    }
  }
  return other;
}

/// Draws the six panels, and those of `--beside` below them.
void draw_figure(const PlanFigure& figure, const PlanOptionsGiven& given,
                 const PipelineSettings& settings) {
  if (given.beside.empty()) {
    draw_plan(figure, given.common.figure);
    return;
  }
  const PlanSettings& s = settings.plan;
  const DigitisedFigure other = digitised_figure_from_json(read_file(given.beside), given.beside,
                                                           *figure.target, s.gain_law(), s.speed);
  const PlanFigure beside = as_figure(*figure.target, other, settings, given.beside);
  draw_plan(figure, given.common.figure, &beside);
}

/// Everything that is reported about one plan.
struct Result {
  PlanStatus status = PlanStatus::EmptyTarget;
  Plan plan;
  PlanStats stats;
  PlanTrace trace;
  PlayedPlan played;
  PlanQuality quality;
  std::optional<double> weighted;  ///< RMSE by the target's weights, where it has some
  std::vector<Control> controls;
  std::vector<std::string> warnings;  ///< of the field and of the plan
  std::string advice;                 ///< about fewer paths, if they are felt better
  Plan other;                         ///< of another target, for the controls
};

Result plan_paths(const TargetField& target, const PlanSettings& s, bool traced) {
  Planner planner(s, target.size());
  Result r;
  // with a budget, a first plan measures how much work fits into it
  if (s.budget > 0.0) planner.plan(target, r.plan, r.stats);
  planner.reset();
  r.status = planner.plan(target, r.plan, r.stats);
  // a second time with the intermediate results, so that collecting them is not in the times
  PlanStats unused;
  if (traced && r.stats.clusters > 0) planner.plan(target, r.plan, unused, &r.trace);
  if (r.status != PlanStatus::Planned) return r;
  planner.reset();
  planner.plan(another_target(target, static_cast<std::uint64_t>(s.seed)), r.other, unused);
  return r;
}

Result plan_foci(const TargetField& target, const PipelineSettings& settings) {
  AmPlanner planner(am_settings(settings, settings.emission_rate()), target.size());
  Result r;
  r.status = planner.plan(target, r.plan, r.stats);
  PlanStats unused;
  if (r.status != PlanStatus::Planned) return r;
  const auto seed = static_cast<std::uint64_t>(settings.plan.seed);
  planner.plan(another_target(target, seed), r.other, unused);
  return r;
}

/// Returns the quality of a plan as it is played. @param widths further widths of the focal point,
/// besides that of the settings [m].
PlanQuality quality_of(const TargetField& target, const Plan& plan, const SegmentPressures& played,
                       const PipelineSettings& settings, const std::vector<double>& widths,
                       WorkerPool& pool) {
  const GainLaw gain = settings.plan.gain_law();
  PlanQuality quality;
  quality.sigma = settings.sigma();
  quality.full_scale_pressure = emit_settings(settings, max_pressure(target)).full_scale_pressure;
  quality.planned = score_plan(target, plan, 0, settings.sigma(), gain, nullptr, pool);
  quality.played = score_plan(target, plan, 0, settings.sigma(), gain, &played, pool);
  for (const double sigma : widths) {
    quality.at.push_back({sigma, score_plan(target, plan, 0, sigma, gain, &played, pool)});
  }
  return quality;
}

/// Fills in the emission of the plan.
void play(const TargetField& target, const PipelineSettings& settings, Result& r) {
  TargetFrame frame;
  frame.patches.push_back(target);
  LiftedPlan lifted;
  lift(r.plan, frame, lifted);
  const DeviceInfo device = settings.device_info();
  r.played = played_plan(lifted, device.emission_rate(), device.max_focus_speed());
  r.warnings = played_warnings(r.played);
}

/// @throws InputError for a field that cannot be planned. @param path names it.
Result plan_field(const TargetField& target, const PipelineSettings& settings, bool traced,
                  const std::string& path) {
  Result r =
      is_am(settings)
          ? plan_foci(target, settings)
          : plan_paths(target, playable_plan_settings(settings, settings.emission_rate()), traced);
  if (r.status == PlanStatus::InvalidTarget) {
    throw InputError(
        path + ": the field has a value that cannot be planned; pressures must be finite and >= 0");
  }
  play(target, settings, r);
  return r;
}

/// Fills in the quality of the plan. @param widths as of quality_of().
void score(const TargetField& target, const PipelineSettings& settings,
           const std::vector<double>& widths, Progress& progress, Result& r) {
  const PlanSettings& s = settings.plan;
  const SegmentPressures pressures = played(target, r.plan, settings);
  WorkerPool pool(settings.threads);
  r.quality = quality_of(target, r.plan, pressures, settings, widths, pool);
  if (!target.weight.empty() && !r.plan.empty()) {
    r.weighted = weighted_rmse(target, r.plan, 0, settings.sigma(), s.gain_law(), &pressures);
  }
  if (r.status != PlanStatus::Planned) return;
  progress.next("scoring the controls");
  r.controls = controls(
      target, settings.sigma(), s.gain_law(), s.max_length(), &r.other,
      static_cast<std::uint64_t>(s.seed),
      [&](int done, int all) { progress.show(done, all, "fields"); }, pool);
}

int focal_points(const Plan& plan) {
  return static_cast<int>(plan.paths.size() + plan.foci.size());
}

PowerShare power_share(const Plan& plan, double limit) {
  const int foci = focal_points(plan);
  return {1.0 / foci, even_share(foci, limit), limit};
}

void print_power(std::FILE* out, const Plan& plan, double limit) {
  const PowerShare share = power_share(plan, limit);
  const int foci = focal_points(plan);
  fmt::print(
      out,
      "  power: {} focal point{} at once, each with {:.1f} % of the array's power; if all request "
      "the same pressure, the power limit of {:g} allows each {:.1f} % of full scale\n",
      foci, foci == 1 ? "" : "s", 100.0 * share.array, limit, 100.0 * share.pressure);
}

/// Prints why there is no plan.
void print_nothing(std::FILE* out, const std::string& field, bool pressed, bool am) {
  const char* reason = !pressed ? "no pressure anywhere"
                       : am     ? "no focus would reach its skin"
                                : "no pressure where its weight is above 0";
  fmt::print(out, "{}: {}, so no {}\n", field, reason, am ? "focus" : "path");
}

void write_plan(const Result& r, const TargetField& target, const PipelineSettings& settings,
                bool array_given, const std::string& json) {
  PlanFileExtras extras;
  PowerShare power;
  if (!r.plan.empty()) {
    power = power_share(r.plan, power_limit(settings));
    extras.power = &power;
  }
  extras.method = settings.method;
  if (extras.method == Method::ProStm) extras.preset = settings.plan.preset;
  extras.stats = &r.stats;
  extras.quality = &r.quality;
  if (array_given) extras.sensation = sensation_interval(settings.transducers);
  extras.controls = &r.controls;
  extras.warnings = &r.warnings;
  extras.program = version_text();
  if (extras.method == Method::ProStm) extras.played = &r.played;
  write_file(json, plan_to_json(r.plan, target, extras, settings_groups(settings)));
}

/// Whether plans are made for the width of the array's focus, if it is known; the paper's presets
/// keep [plan] sigma.
bool counts_on_own_width(const PipelineSettings& settings) {
  if (is_am(settings)) return true;
  return settings.plan.traits().is_fitted();
}

void print_plan(std::FILE* out, const Result& r, const TargetField& target,
                const PipelineSettings& settings, std::optional<double> own_width) {
  const std::string felt = felt_words(settings);
  print_verdict(out, target, r.plan, r.quality.played, sensation_interval(settings.transducers),
                own_width ? kPerceptLimits : "not computed without --array");
  if (!r.advice.empty()) fmt::print(out, "  {}\n", r.advice);
  print_warnings(out, control_warnings(r.quality.played, r.controls, !felt.empty()));
  if (is_am(settings)) {
    print_foci(out, r.plan, r.stats, max_pressure(target), felt);
  } else {
    print_paths(out, r.plan, r.played, r.stats, felt);
  }
  print_quality(out, r.quality, r.controls);
  if (own_width) {
    fmt::print(out, "  focus of {} on the skin: sigma {:.2f} mm\n", settings.transducers.name,
               1e3 * *own_width);
  }
  if (r.weighted) {
    fmt::print(out, "  {:<44} {:>7.3f}\n", "this plan, by the field's weights", *r.weighted);
  }
  print_power(out, r.plan, power_limit(settings));
}

void write_results(const Result& r, const TargetField& target, const PipelineSettings& settings,
                   const PlanOptionsGiven& given) {
  if (!given.common.json.empty()) {
    write_plan(r, target, settings, given.common.array.has_value(), given.common.json);
  }
  if (given.common.figure.empty()) return;
  PlanFigure figure = as_figure(target, r.plan, r.trace, settings);
  figure.metrics = r.quality.played;
  figure.controls = r.controls;
  figure.title =
      given.field +
      (is_am(settings) ? ", method am" : ", preset " + std::string(name_of(settings.plan.preset)));
  draw_figure(figure, given, settings);
}

/// Makes plans use the width of the array's focus if an array is given. @param other_widths gets
/// the width that plans do not use [m]. @return the array's width [m].
std::optional<double> use_own_width(const PlanOptionsGiven& given, const TargetField& target,
                                    PipelineSettings& settings, std::vector<double>& other_widths) {
  if (!given.common.array) return std::nullopt;
  const double own = sigma_on_skin(settings.transducers, target, settings.sigma());
  if (settings.array_width && counts_on_own_width(settings)) {
    other_widths.push_back(settings.sigma());
    settings.plan.sigma = settings.am.sigma = own;
  } else {
    other_widths.push_back(own);
  }
  return own;
}

/// Fills in all scores, including that of the percept if an array is given.
void judge(const TargetField& target, const PipelineSettings& settings,
           const std::vector<double>& widths, bool by_felt, Result& r) {
  Progress progress("scoring the plan");
  score(target, settings, widths, progress, r);
  if (!by_felt) return;
  progress.next("computing the percept");
  const PlanPercept percept = percept_of(target, r.plan, settings);
  r.quality.played.felt_skill = percept.skill;
  r.quality.played.sensation_level = percept.sensation_level;
  const bool chosen = is_am(settings) || settings.plan.preset == Preset::Felt;
  if (chosen || !std::isfinite(percept.skill)) return;
  progress.next("computing the percepts of fewer paths");
  const auto paths = static_cast<int>(r.plan.paths.size());
  r.advice = fewer_paths_advice(target, settings, paths, r.quality.played);
}

}  // namespace

int plan_command(const PlanOptionsGiven& given) {
  PipelineSettings settings = make_settings(given.common, std::nullopt);
  require_playable(settings, settings.device_info());
  if (!given.beside.empty() && is_am(settings))
    throw InputError("--beside shows the steps of --method pro-stm; leave it out with am");
  FieldKind kind = FieldKind::Json;
  const TargetField target = read_field(given.field, given.file, &kind);
  std::vector<double> other_widths;
  const std::optional<double> own_width = use_own_width(given, target, settings, other_widths);

  Result r = plan_field(target, settings, !given.common.figure.empty(), given.field);
  // before the scores of a large field, which take their time
  std::FILE* out = prose(given.common.json);
  fmt::print(out, "{}\n", field_in_words(given.field, kind, target, given.file));
  const auto doubts = field_warnings(kind, target, given.file);
  r.warnings.insert(r.warnings.begin(), doubts.begin(), doubts.end());
  print_warnings(out, r.warnings);
  std::fflush(out);

  judge(target, settings, other_widths, given.common.array.has_value(), r);
  const bool by_felt = !felt_words(settings).empty();
  const auto losses = control_warnings(r.quality.played, r.controls, by_felt);
  r.warnings.insert(r.warnings.end(), losses.begin(), losses.end());
  write_results(r, target, settings, given);
  if (r.status == PlanStatus::EmptyTarget) {
    print_nothing(out, given.field, max_pressure(target) > 0.0, is_am(settings));
  } else {
    print_plan(out, r, target, settings, own_width);
  }
  say_written(out, given.common.figure);
  say_written(out, given.common.json);
  return 0;
}

}  // namespace prostm::app
