#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "common.hpp"
#include "field/field_words.hpp"
#include "field/quality_words.hpp"
#include "prostm/acoustics/field/focus_width.hpp"
#include "prostm/acoustics/skin/sensation_level.hpp"
#include "prostm/commit.hpp"
#include "prostm/core/file/file.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/units.hpp"
#include "prostm/emit/played.hpp"
#include "prostm/figure/figures.hpp"
#include "prostm/io/field/field_file.hpp"
#include "prostm/io/physical_file.hpp"
#include "prostm/io/plan_file.hpp"
#include "prostm/io/widths_file.hpp"
#include "prostm/score/physical.hpp"
#include "prostm/score/plan_percept.hpp"

namespace prostm::app {
namespace {

/// The plan, and the raster for its field: the target's if a target is given.
struct Input {
  Plan plan;
  TargetField raster;
  double full_scale_pressure = 0.0;  // full scale stated by the plan; 0 without one
  double sigma = 0.0;                // focal width that the plan was made for [m]; 0: unknown
  bool has_target = false;
};

Input read_input(const FieldOptionsGiven& given) {
  PlanFile file = plan_from_json(read_file(given.plan), given.plan);
  if (file.plan.empty()) {
    throw InputError(given.plan + ": has no path and no focus, so there is no field to compute");
  }
  const auto first = [](const auto& part) { return part.patch == 0; };
  if (!std::all_of(file.plan.paths.begin(), file.plan.paths.end(), first) ||
      !std::all_of(file.plan.foci.begin(), file.plan.foci.end(), first)) {
    throw InputError(given.plan +
                     ": has a path or focus on a second hand; the field is computed for plans of "
                     "one");
  }
  Input input{file.plan, file.raster, file.full_scale_pressure, file.sigma, false};
  if (given.target.empty()) return input;
  input.raster = read_field(given.target, given.file);
  input.has_target = true;
  if (input.raster.rows != file.raster.rows || input.raster.cols != file.raster.cols ||
      std::abs(input.raster.cell - file.raster.cell) > 1e-6 ||
      (input.raster.origin - file.raster.origin).norm() > 1e-6 ||
      !input.raster.X_DP.isApprox(file.raster.X_DP, 1e-6)) {
    throw InputError(fmt::format(
        "{}: is not the field of the plan {}: rasters and planes differ ({} × {} cells of {:g} mm, "
        "the plan's {} × {} of {:g} mm)",
        given.target, given.plan, input.raster.rows, input.raster.cols, 1e3 * input.raster.cell,
        file.raster.rows, file.raster.cols, 1e3 * file.raster.cell));
  }
  return input;
}

void print_loop(std::FILE* out, const PhysicalReport& r) {
  fmt::print(out, "  a loop of {:.1f} ms, periods within {:.1f} % of the plan's\n",
             1e3 * r.loop->samples / r.loop->sample_rate, 100.0 * r.loop->largest_stretch());
  for (std::size_t i = 0; i < r.loop->played.paths.size(); ++i) {
    const PlayedPath& path = r.loop->played.paths[i];
    fmt::print(out, "  path {}: {:.2f} m/s, {:.2f} ms a lap\n", i + 1, path.speed,
               1e3 * path.period);
  }
}

void print_levels(std::FILE* out, const PhysicalReport& r) {
  const TransducerArray& array = *r.array;
  const double low = std::pow(array.amplitude_low / array.amplitude, 2),
               high = std::pow(array.amplitude_high / array.amplitude, 2);
  fmt::print(
      out, "  radiation pressure on the skin: peak {:.3g} Pa, largest mean over the loop {:.3g} Pa",
      r.field->largest, r.field->largest_mean);
  if (high > low) {
    fmt::print(out, " (sources differ on the array: {:.2f} to {:.2f} times that)", low, high);
  }
  fmt::print(out,
             "\n  largest side lobe, more than {:.0f} mm from the paths: {:.1f} % of the peak\n",
             1e3 * kBesidePaths, 100.0 * r.field->side_lobe);
  fmt::print(
      out,
      "  focal points: position error {:.1f} mm mean, {:.1f} mm max; {:.2f} of the requested "
      "acoustic pressure, {:.2f} to {:.2f}\n",
      1e3 * r.focus.mean_offset, 1e3 * r.focus.worst_offset, r.focus.mean_level,
      r.focus.least_level, r.focus.most_level);
}

void print_power(std::FILE* out, const PhysicalReport& r) {
  const LoopDriveResult& d = *r.drives;
  const auto transducers = static_cast<double>(r.array->position.size());
  fmt::print(out,
             "  drives: intensity 1 is {:.0f} Pa rms; the largest is {:.2f}, mean Σ|q|² {:.1f} of "
             "{:.0f} transducers, {:.1f} % at full drive; {} of {} samples weaker than planned\n",
             d.full_scale_pa, d.largest_drive, d.mean_power, transducers, 100.0 * d.full_share,
             d.short_samples, r.loop->samples);
  if (d.merged > 0) {
    fmt::print(out, "  two focal points coincided {} times: the stronger one was played\n",
               d.merged);
  }
}

/// Sets the level of the percept. A full scale that was given is that of intensity 1.
void set_sensation(bool full_scale_given, PhysicalReport& r) {
  r.sensation_level = full_scale_given ? sensation_level(r.felt->largest)
                                       : loop_sensation_level(*r.felt, *r.loop, *r.array);
  r.sensation_interval = full_scale_given ? sensation_interval() : sensation_interval(*r.array);
}

void print_felt(std::FILE* out, const PhysicalReport& r) {
  if (r.felt == nullptr) {
    fmt::print(out, "  the percept is {}\n", kPerceptLimits);
    return;
  }
  fmt::print(out,
             "  felt like a vibration at 250 Hz of {:.2f} µm rms at the peak, {:.2f} µm over the "
             "whole skin{}",
             1e6 * r.felt->largest, 1e6 * r.felt->intensity,
             r.sensation_interval.sound == SoundSource::Given ? "" : ", at the nominal amplitude");
  if (r.ghosts != nullptr) {
    fmt::print(out, "; {} ghosts above half of the peak, the strongest {:.0f} %", r.ghosts->count,
               100.0 * r.ghosts->largest);
  }
  fmt::print(out, "\n");
}

/// Prints how good the field is; without a target only its strength.
void print_quality(std::FILE* out, const PhysicalReport& r) {
  fmt::print(out, "{} on {}, {}{}\n", r.plan, r.array->name, r.solver,
             r.quality == nullptr ? "; no target to compare with, --field FILE gives one"
                                  : "; a shape of 1 is perfect, 0 is no better than an even field");
  if (r.quality != nullptr) {
    print_quality_numbers(out, *r.quality, r.sensation_interval, kPerceptLimits);
  } else if (r.felt != nullptr) {
    print_sensation(out, r.sensation_level, r.sensation_interval);
  }
  print_warnings(out, r.warnings);
}

void print_spectrum(std::FILE* out, const PhysicalReport& r) {
  if (r.spectrum.empty()) return;
  fmt::print(out, "  {:>8} {:>10} {:>10} {:>10} {:>10} {:>10} {:>10}\n", "felt at", "share of",
             "share of", "strongest", "place", "all skin", "");
  fmt::print(out, "  {:>8} {:>10} {:>10} {:>10} {:>10} {:>10} {:>10}\n", "Hz", "strongest",
             "intensity", "µm rms", "mm/s rms", "µm rms", "mm/s rms");
  for (const FeltHarmonic& h : r.spectrum) {
    fmt::print(out, "  {:>8.1f} {:>10.4f} {:>10.4f} {:>10.4f} {:>10.3f} {:>10.4f} {:>10.3f}\n",
               h.frequency, h.share_at_strongest, h.share_of_intensity,
               1e6 * h.displacement_strongest, 1e3 * h.velocity_strongest,
               1e6 * h.displacement_skin, 1e3 * h.velocity_skin);
  }
}

void print_scores(std::FILE* out, const PhysicalReport& r) {
  if (r.envelope_metrics == nullptr) return;
  std::vector<MetricsRow> rows;
  rows.emplace_back("envelope: the largest over the loop", *r.envelope_metrics);
  if (r.felt_metrics != nullptr) rows.emplace_back("felt: perceived intensity", *r.felt_metrics);
  rows.emplace_back("mean over the loop, for comparison only", *r.mean_metrics);
  print_metrics(out, "against the target", rows);
  fmt::print(out,
             "  (skin feels movement, not the mean: by the mean a flat field can beat any path)\n");
}

/// Prints width and strength of one focus at heights of 100 to 300 mm, up to 90 mm off the axis,
/// tilted by up to 60°.
void tell_widths(const TransducerArray& array, const FieldOptionsGiven& given) {
  constexpr std::array kHeights{0.10, 0.15, 0.20, 0.25, 0.30};  // [m]
  constexpr std::array kOffsets{0.0, 0.03, 0.06, 0.09};         // [m]
  constexpr std::array kTiltsDegrees{0.0, 20.0, 40.0, 60.0};
  std::array<double, kTiltsDegrees.size()> tilts{};
  for (std::size_t i = 0; i < tilts.size(); ++i) tilts[i] = kTiltsDegrees[i] * kPi / 180.0;
  const Medium air;
  Progress progress("measuring foci");
  const std::vector<FocusWidthEntry> table =
      focus_width_table(PackedArray(array, air), air, kHeights, kOffsets, tilts);
  progress.clear();

  std::FILE* out = prose(given.common.json);
  fmt::print(out, "one focus of {} at full drive; sigma along the tilt × across it\n", array.name);
  fmt::print(out, "  {:>9} {:>9} {:>6} {:>17} {:>14}\n", "height mm", "beside mm", "tilt °",
             "sigma mm", "pressure Pa");
  for (const FocusWidthEntry& e : table) {
    fmt::print(out, "  {:>9.0f} {:>9.0f} {:>6.0f} {:>8.2f} × {:>6.2f} {:>14.1f}\n", 1e3 * e.height,
               1e3 * e.offset, e.tilt * 180.0 / kPi, 1e3 * e.width.along, 1e3 * e.width.across,
               e.width.level);
  }
  if (!given.common.json.empty()) {
    write_file(given.common.json, widths_to_json(array.name, table));
  }
  say_written(out, given.common.json);
}

/// Drives for the whole loop.
LoopDriveResult solve(const TransducerArray& array, const Medium& air, const LoopSamples& loop,
                      const FieldOptionsGiven& given, Progress& progress) {
  LoopDriveSettings settings;
  settings.focus.method = solver_of(given.solver);
  settings.full_scale_pa = given.full_scale_pa;
  settings.transducer.memoryless = given.memoryless;
  const auto go_on = [&](int done, int of) {
    progress.show(done, of, "samples");
    return true;  // nothing is written before the end, so a signal may end it at any time
  };
  LoopDriveResult drives;
  loop_drives(array, air, loop, settings, go_on, drives);
  return drives;
}

/// The results that a report refers to.
struct Judgement {
  FeltField felt;
  Metrics quality, envelope, mean, of_felt;
  Ghosts ghosts;
};

/// Returns the quality by Eq. (1), at the width that the plan was made for, as `prostm plan` does.
Metrics score_by_model(const Input& input, const PipelineSettings& settings,
                       const EmitSettings& emit) {
  TargetFrame frame;
  frame.patches.push_back(input.raster);
  const double sigma = input.sigma > 0.0 ? input.sigma : settings.sigma();
  const SegmentPressures played =
      played_pressures(input.plan, frame, emit, settings.emission_rate());
  return score_plan(input.raster, input.plan, 0, sigma, settings.plan.gain_law(), &played);
}

/// Compares the field with the target, and its percept too if `report` has it.
/// @param quality quality by Eq. (1).
void judge(const Input& input, const Metrics& quality, PhysicalReport& report, Judgement& out) {
  const TargetField& target = input.raster;
  const double coverage = quality.coverage;
  out.quality = quality;
  report.quality = &out.quality;
  out.envelope = score_physical(target, report.field->envelope, coverage);
  out.mean = score_physical(target, report.field->mean, coverage);
  report.envelope_metrics = &out.envelope;
  report.mean_metrics = &out.mean;
  if (report.felt == nullptr) return;
  out.of_felt = score_physical(target, out.felt.percept, coverage);
  out.ghosts = ghosts_of(target, out.felt.percept);
  out.quality.felt_skill = out.of_felt.skill_8;
  out.quality.sensation_level = report.sensation_level;
  report.felt_metrics = &out.of_felt;
  report.ghosts = &out.ghosts;
}

/// Returns the line under the title of the figure.
std::string summary_of(const PhysicalReport& r) {
  if (r.quality != nullptr) return quality_line(*r.quality, r.sensation_interval);
  if (r.felt == nullptr || !std::isfinite(r.sensation_level)) return {};
  return "felt strength " + level_words(r.sensation_level, r.sensation_interval);
}

void tell(const PhysicalReport& report, const Input& input, const FieldOptionsGiven& given) {
  if (!given.common.json.empty()) write_file(given.common.json, physical_to_json(report));
  if (!given.common.figure.empty()) {
    draw_physical({&input.raster, &input.plan, report.field, report.felt, input.has_target,
                   fmt::format("{} on {}", given.plan, report.array->name), summary_of(report)},
                  given.common.figure);
  }
  std::FILE* out = prose(given.common.json);
  print_quality(out, report);
  print_felt(out, report);
  print_levels(out, report);
  print_loop(out, report);
  print_power(out, report);
  print_spectrum(out, report);
  print_scores(out, report);
  say_written(out, given.common.figure);
  say_written(out, given.common.json);
}

/// Returns the emission that the plan was made for, unless the settings give a full scale.
EmitSettings emission_of(const PipelineSettings& settings, const Input& input) {
  EmitSettings emit = settings.emit;
  if (emit.full_scale_pressure == 0.0) emit.full_scale_pressure = input.full_scale_pressure;
  emit.power_limit = power_limit(settings);
  return emit;
}

}  // namespace

int field_command(const FieldOptionsGiven& given) {
  PipelineSettings all = make_settings(given.common, std::nullopt);
  const TransducerArray& array = all.transducers;
  if (given.widths != given.plan.empty())
    throw InputError("prostm field needs a plan, or --widths without one");
  if (given.widths && given.felt_spectrum)
    throw InputError("--felt-spectrum needs a plan; --widths has no percept");
  if (given.widths) {
    tell_widths(array, given);
    return 0;
  }
  const Input input = read_input(given);
  TargetFrame frame;
  frame.patches.push_back(input.raster);
  const EmitSettings emit = emission_of(all, input);
  const LoopSamples loop = plan_loop(input.plan, frame, emit, all.emission_rate());
  const Medium air;
  Progress progress("solving");
  const LoopDriveResult drives = solve(array, air, loop, given, progress);
  const PackedArray packed(array, air);
  WorkerPool pool(all.threads);
  progress.next("computing the pressure on the skin");
  const bool felt = is_felt(input.raster, loop);
  const PhysicalField field =
      physical_field(packed, air, input.raster, loop, drives, felt ? felt_parts(loop) : 0, pool);

  PhysicalReport report;
  report.plan = given.plan;
  report.solver = given.solver;
  report.array = &array;
  report.raster = &input.raster;
  report.loop = &loop;
  report.warnings = played_warnings(loop.played);
  report.drives = &drives;
  report.field = &field;
  report.focus = focus_accuracy(packed, loop, drives, input.raster.X_DP);
  report.settings = settings_groups(std::as_const(all));
  report.program = version_text();
  Judgement judgement;
  if (felt) {
    progress.next("computing what is felt");
    FeelingSkin skin(input.raster);
    judgement.felt =
        skin.feel(input.raster, loop.samples / loop.sample_rate, field.parts, field.part);
    report.felt = &judgement.felt;
    set_sensation(given.full_scale_pa > 0.0, report);
    if (given.felt_spectrum) report.spectrum = felt_spectrum(input.raster, skin.motion());
  }
  if (input.has_target) judge(input, score_by_model(input, all, emit), report, judgement);
  progress.clear();
  tell(report, input, given);
  return 0;
}

}  // namespace prostm::app
