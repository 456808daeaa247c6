#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "common.hpp"
#include "core/input_error.hpp"
#include "figure/figures.hpp"
#include "io/recorder.hpp"
#include "pipeline/runner.hpp"
#include "plan/quasi_static.hpp"

namespace prostm::app {
namespace {

constexpr double kLiveBudget = 3e-3;  // for a plan in real time [s]

/// Records, keeps the instant nearest to one for the picture, and watches for Ctrl-C.
class Observer final : public RunObserver {
 public:
  /// @param picture_at time of the picture, when there is to be one [s].
  Observer(Recorder* recorder, std::optional<double> picture_at, double seconds)
      : recorder_(recorder), picture_at_(picture_at), seconds_(seconds) {}

  bool on_plan(const ContactFrame& contact, const PlanFrame& plan) override {
    if (recorder_ != nullptr) {
      const bool planned = plan.status == PlanStatus::Planned;
      recorder_->append(contact.target, contact.hands, planned ? &plan.plan : nullptr,
                        planned ? &plan.stats : nullptr);
    }
    if (picture_at_ && plan.status == PlanStatus::Planned) {
      const double away = std::abs(contact.target.time - *picture_at_);
      if (away < away_) {
        away_ = away;
        contact_ = contact;
        plan_ = plan;
      }
    }
    return !interrupt_.requested();
  }

  bool on_progress(double time) override {
    progress_.show(time, seconds_, "s");
    return !interrupt_.requested();
  }

  bool interrupted() const { return interrupt_.requested(); }
  bool has_instant() const { return std::isfinite(away_); }
  const ContactFrame& contact() const { return contact_; }
  const PlanFrame& plan() const { return plan_; }

 private:
  Recorder* recorder_;
  std::optional<double> picture_at_;
  double seconds_, away_ = std::numeric_limits<double>::infinity();
  ContactFrame contact_;
  PlanFrame plan_;
  Interrupt interrupt_;
  Progress progress_{"running"};
};

void draw_instant(const Observer& observer, const PipelineSettings& settings, const GridShape& grid,
                  const std::string& path) {
  if (!observer.has_instant()) {
    throw InputError("no picture was drawn in " + path +
                     ": no pressure reached a hand during the run");
  }
  const ContactFrame& contact = observer.contact();
  SceneFigure figure;
  figure.nx = grid.nx;
  figure.nz = grid.nz;
  figure.cell = grid.cell;
  figure.origin = grid.p_DF({0, 2}) + Vec2::Constant(0.5 * grid.cell);
  figure.smoke = contact.side.smoke;
  figure.hand = contact.side.hand;
  for (const Vec3& p : settings.transducers.position) figure.array.emplace_back(p.x(), p.z());
  LiftedPlan lifted;
  lift(observer.plan().plan, contact.target, lifted);
  for (const LiftedPath& lifted_path : lifted.paths) {
    figure.foci.insert(figure.foci.end(), lifted_path.p_D.begin(), lifted_path.p_D.end());
  }
  for (const LiftedFocus& focus : lifted.foci) figure.foci.push_back(focus.p_D);
  const PlanSettings plan = plan_settings(settings);
  for (std::size_t patch = 0; patch < contact.target.patches.size(); ++patch) {
    const TargetField& target = contact.target.patches[patch];
    const double sigma =
        method_from_name(settings.method) == Method::Am ? settings.am.sigma : plan.sigma_on(target);
    std::vector<double> field(target.size());
    quasi_static_field(observer.plan().plan, static_cast<int>(patch), target, sigma,
                       settings.plan.gain_law(), field);
    figure.targets.push_back(target);
    figure.reconstructions.push_back(std::move(field));
  }
  figure.plan = observer.plan().plan;
  figure.title = fmt::format("{} at {:.2f} s", settings.scene, contact.target.time);
  draw_scene(figure, path);
}

nlohmann::ordered_json summary_json(const RunSummary& s, const PipelineSettings& settings) {
  const double samples = std::max<double>(1.0, static_cast<double>(s.emit.samples));
  const double laps = std::max<double>(1.0, static_cast<double>(s.emit.laps_started));
  return {{"format", "prostm-run/1"},
          {"scene", settings.scene},
          {"method", settings.method},
          {"seconds", s.seconds},
          {"stopped", s.stopped},
          {"fluid_steps", s.fluid_steps},
          {"skipped_fluid_steps", s.skipped_fluid_steps},
          {"fluid_rate_hz", s.seconds > 0 ? static_cast<double>(s.fluid_steps) / s.seconds : 0.0},
          {"plans", s.plans},
          {"empty_updates", s.empty_updates},
          {"skipped_updates", s.skipped_updates},
          {"plan_rate_hz",
           s.seconds > 0 ? static_cast<double>(s.plans + s.empty_updates) / s.seconds : 0.0},
          {"blocks", s.device.blocks},
          {"late_blocks", s.device.late_blocks},
          {"missed_blocks", s.device.missed_blocks},
          {"queue_blocks", s.device.queue_blocks},
          {"max_focus_step_mm", s.emit.max_focus_step * 1e3},
          {"max_path_length_mm", s.max_path_length * 1e3},
          {"max_skin_length_mm", s.max_skin_length * 1e3},
          {"long_paths", s.long_paths},
          {"crossings", s.crossings},
          {"laps_completed", 1.0 - static_cast<double>(s.emit.laps_cut) / laps},
          {"saturated", s.emit.saturated},
          {"samples", s.emit.samples},
          {"power_limited", s.emit.limited},
          {"faded_share", static_cast<double>(s.emit.faded) / samples},
          {"stalls", s.emit.stalls},
          {"full_scale_pressure_pa", s.full_scale_pressure},
          {"mean_relative_divergence", s.mean_divergence},
          {"fluid_resets", s.fluid_resets},
          {"joints_outside", s.joints_outside},
          {"unrecorded", s.unobserved},
          {"latency_ms", to_json(s.latency, 1e3)},
          {"redraw_ms", to_json(s.redraw, 1e3)},
          {"stage_ms",
           {{"track", to_json(s.track, 1e3)},
            {"hand", to_json(s.hand, 1e3)},
            {"fluid", to_json(s.fluid, 1e3)},
            {"contact", to_json(s.contact, 1e3)},
            {"plan", to_json(s.plan, 1e3)},
            {"lift", to_json(s.lift, 1e3)}}}};
}

void print_paths(std::FILE* out, const RunSummary& s) {
  fmt::print(out,
             "paths: longest {:.1f} mm in the plane, {:.1f} mm on the skin; {} too long, {} "
             "crossings; largest focus step {:.3f} mm\n",
             s.max_path_length * 1e3, s.max_skin_length * 1e3, s.long_paths, s.crossings,
             s.emit.max_focus_step * 1e3);
}

void print_summary(std::FILE* out, const RunSummary& s, const PipelineSettings& settings) {
  const auto stage = [&](const char* name, const Summary& t) {
    fmt::print(out, "  {:<10} {:>8.3f} {:>8.3f} {:>8.3f}\n", name, t.p50 * 1e3, t.p99 * 1e3,
               t.max * 1e3);
  };
  fmt::print(out,
             "{}: {:.1f} s, {} fluid steps ({} skipped), {} plans ({} updates without pressure, {} "
             "skipped)\n",
             settings.scene, s.seconds, s.fluid_steps, s.skipped_fluid_steps, s.plans,
             s.empty_updates, s.skipped_updates);
  fmt::print(out, "device: {} blocks, {} late, {} missed, queue of {} blocks\n", s.device.blocks,
             s.device.late_blocks, s.device.missed_blocks, s.device.queue_blocks);
  if (method_from_name(settings.method) == Method::Am) {
    fmt::print(out,
               "foci: at most {}, {} at {:g} Hz; largest step of one that sounds {:.3f} mm, {} "
               "beyond the focal points\n",
               settings.am.foci, settings.emit.am_waveform, settings.emit.am_frequency,
               s.emit.max_focus_step * 1e3, s.emit.dropped_paths);
  } else {
    print_paths(out, s);
  }
  fmt::print(out, "drive: full scale {:.3f} Pa, {} of {} samples saturated, {} power-limited\n",
             s.full_scale_pressure, s.emit.saturated, s.emit.samples, s.emit.limited);
  fmt::print(out, "fluid: {:.2g} of the divergence left on the mean\n", s.mean_divergence);
  if (s.joints_outside > 0) {
    fmt::print(
        out,
        "hand: {} joint positions were outside the fluid's box; the skin there has no target\n",
        s.joints_outside);
  }
  if (s.unobserved > 0) fmt::print(out, "recording: {} updates were missed\n", s.unobserved);
  fmt::print(out, "  [ms]            p50      p99      max\n");
  stage("latency", s.latency);
  stage("redraw", s.redraw);
  stage("track", s.track);
  stage("hand", s.hand);
  stage("fluid", s.fluid);
  stage("contact", s.contact);
  stage("plan", s.plan);
  stage("lift", s.lift);
}

}  // namespace

int run_command(const RunOptionsGiven& given) {
  check_outputs(given.common);
  PipelineSettings settings = make_settings(given.common, given.scene);
  RunOptions options;
  options.mode = given.stepped               ? RunMode::Stepped
                 : given.as_fast_as_possible ? RunMode::AsFastAsPossible
                                             : RunMode::RealTime;
  settings.simulated_array.realtime = options.mode == RunMode::RealTime;
  // a clock is running: the planner gets a share of an update, not a number of tries
  if (options.mode == RunMode::RealTime && method_from_name(settings.method) == Method::ProStm &&
      settings.plan.preset == "best" && settings.plan.budget == 0.0 && !given.common.budget_ms) {
    settings.plan.budget = kLiveBudget;
  }
  settings.side_view = !given.common.figure.empty();

  double duration = 0.0;
  auto hands = make_hands(given.hand, settings, duration);
  options.seconds = given.seconds.value_or(std::isfinite(duration) ? duration : 60.0);
  if (!(options.seconds > 0.0 && options.seconds <= 86400.0)) {
    throw InputError(
        fmt::format("--seconds {} must be above 0 and at most 86400", options.seconds));
  }
  if (given.figure_at && !(*given.figure_at >= 0.0 && *given.figure_at <= options.seconds)) {
    throw InputError(fmt::format("--figure-at {} must be between 0 and the run's {} s",
                                 *given.figure_at, options.seconds));
  }
  Pipeline pipeline(settings, std::move(hands));

  std::unique_ptr<Recorder> recorder;
  if (!given.record.empty()) {
    recorder = std::make_unique<Recorder>(given.record, settings_json(settings));
    recorder->set_attribute("scene", settings.scene);
    recorder->set_attribute("hand", given.hand);
  }
  std::optional<double> picture_at;
  if (settings.side_view) picture_at = given.figure_at.value_or(0.5 * options.seconds);
  Observer observer(recorder.get(), picture_at, options.seconds);
  const RunSummary summary = run(pipeline, settings, options, observer);

  nlohmann::ordered_json json = summary_json(summary, settings);
  json["hand"] = given.hand;
  json["settings"] = nlohmann::ordered_json::parse(settings_json(settings));
  if (recorder) {
    recorder->set_attribute("summary", json.dump());
    recorder->close();
  }
  print_summary(prose(given.common.json), summary, settings);
  write_json(given.common.json, json);
  if (!given.common.figure.empty()) {
    draw_instant(observer, settings, pipeline.smoke().fluid().grid(), given.common.figure);
  }
  return observer.interrupted() ? kInterrupted : 0;
}

}  // namespace prostm::app
