#include "run_summary.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common.hpp"

namespace prostm::app {
namespace {

/// The share of laps that were not cut short.
double laps_completed(const RunSummary& s) {
  const double laps = std::max<double>(1.0, static_cast<double>(s.emit.laps_started));
  return 1.0 - static_cast<double>(s.emit.laps_cut) / laps;
}

/// The share of the hands' skin that was not planned because the array cannot press there.
double steep_share(const RunSummary& s) {
  const auto cells = static_cast<double>(s.skin_cells + s.steep_cells);
  return static_cast<double>(s.steep_cells) / std::max(1.0, cells);
}

void print_paths(std::FILE* out, const RunSummary& s) {
  fmt::print(out,
             "paths: longest {:.1f} mm in the plane, {:.1f} mm on the skin; {} too long, {} "
             "crossings; largest focus step {:.3f} mm\n",
             s.max_path_length * 1e3, s.max_skin_length * 1e3, s.long_paths, s.crossings,
             s.emit.max_focus_step * 1e3);
}

void print_times(std::FILE* out, const RunSummary& s, const PipelineSettings& settings) {
  const auto row = [&](const std::string& name, const Summary& t) {
    fmt::print(out, "  {:<14} {:>8.3f} {:>8.3f} {:>8.3f} {:>8.3f}\n", name, t.mean * 1e3,
               t.p50 * 1e3, t.p99 * 1e3, t.max * 1e3);
  };
  fmt::print(out, "  [ms]               mean      p50      p99      max\n");
  row("latency", s.latency);
  for (int part = 0; part < kLatencyParts; ++part) {
    row(fmt::format("  {}", latency_part_name(part)),
        s.latency_parts[static_cast<std::size_t>(part)]);
  }
  row("redraw", s.redraw);
  if (method_from_name(settings.method) == Method::ProStm) {
    fmt::print(out, "  laps completed {:.1f} %, switches: {}\n", 100.0 * laps_completed(s),
               settings.emit.switch_at);
  }
  row("track", s.track);
  row("hand", s.hand);
  row("fluid", s.fluid);
  row("contact", s.contact);
  row("plan", s.plan);
  row("lift", s.lift);
}

nlohmann::ordered_json parts_json(const std::array<Summary, kLatencyParts>& parts) {
  nlohmann::ordered_json json;
  for (int part = 0; part < kLatencyParts; ++part) {
    json[latency_part_name(part)] = to_json(parts[static_cast<std::size_t>(part)], 1e3);
  }
  return json;
}

}  // namespace

nlohmann::ordered_json summary_json(const RunSummary& s, const PipelineSettings& settings) {
  const double samples = std::max<double>(1.0, static_cast<double>(s.emit.samples));
  return {{"format", "prostm-run/1"},
          {"scene", settings.scene},
          {"method", settings.method},
          {"seconds", s.seconds},
          {"stopped", s.stopped},
          {"failure", s.failure ? nlohmann::ordered_json(sentence_of(s.failure))
                                : nlohmann::ordered_json(nullptr)},
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
          {"limited_samples", s.limited_samples},
          {"queue_blocks", s.device.queue_blocks},
          {"max_focus_step_mm", s.emit.max_focus_step * 1e3},
          {"max_path_length_mm", s.max_path_length * 1e3},
          {"max_skin_length_mm", s.max_skin_length * 1e3},
          {"long_paths", s.long_paths},
          {"crossings", s.crossings},
          {"laps_completed", laps_completed(s)},
          {"saturated", s.emit.saturated},
          {"samples", s.emit.samples},
          {"power_limited", s.emit.limited},
          {"faded_share", static_cast<double>(s.emit.faded) / samples},
          {"stalls", s.emit.stalls},
          {"full_scale_pressure_pa", s.full_scale_pressure},
          {"mean_relative_divergence", s.mean_divergence},
          {"fluid_resets", s.fluid_resets},
          {"joints_outside", s.joints_outside},
          {"steep_share", steep_share(s)},
          {"unrecorded", s.unobserved},
          {"switch_at", settings.emit.switch_at},
          {"latency_ms", to_json(s.latency, 1e3)},
          {"latency_parts_ms", parts_json(s.latency_parts)},
          {"redraw_ms", to_json(s.redraw, 1e3)},
          {"stage_ms",
           {{"track", to_json(s.track, 1e3)},
            {"hand", to_json(s.hand, 1e3)},
            {"fluid", to_json(s.fluid, 1e3)},
            {"contact", to_json(s.contact, 1e3)},
            {"plan", to_json(s.plan, 1e3)},
            {"lift", to_json(s.lift, 1e3)}}}};
}

void print_summary(std::FILE* out, const RunSummary& s, const PipelineSettings& settings) {
  fmt::print(out,
             "{}: {:.1f} s, {} fluid steps ({} skipped), {} plans ({} updates without pressure, {} "
             "skipped)\n",
             settings.scene, s.seconds, s.fluid_steps, s.skipped_fluid_steps, s.plans,
             s.empty_updates, s.skipped_updates);
  fmt::print(out, "device: {} blocks, {} late, {} missed, queue of {} blocks\n", s.device.blocks,
             s.device.late_blocks, s.device.missed_blocks, s.device.queue_blocks);
  if (s.limited_samples > 0) {
    fmt::print(out, "device: {} samples were outside its limits and cut down\n", s.limited_samples);
  }
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
  if (s.steep_cells > 0) {
    fmt::print(out,
               "hand: {:.0f} % of its skin was too steep for the array to press on, and not "
               "planned\n",
               100.0 * steep_share(s));
  }
  if (s.unobserved > 0) fmt::print(out, "recording: {} updates were missed\n", s.unobserved);
  print_times(out, s, settings);
}

void print_tracker(std::FILE* out, const TrackerStatus& tracker) {
  fmt::print(out,
             "tracker: {} ({} frames, {} dropped, {} repeated, {} reconnects; hands not taken: {} "
             "unsure, {} frozen)\n",
             tracker.sentence, tracker.frames, tracker.dropped, tracker.repeated,
             tracker.reconnects, tracker.unsure, tracker.frozen);
}

nlohmann::ordered_json tracker_json(const std::optional<TrackerStatus>& tracker) {
  if (!tracker) return nullptr;
  return {{"connected", tracker->connected},   {"frames", tracker->frames},
          {"dropped", tracker->dropped},       {"repeated", tracker->repeated},
          {"unsure", tracker->unsure},         {"frozen", tracker->frozen},
          {"reconnects", tracker->reconnects}, {"sentence", tracker->sentence}};
}

}  // namespace prostm::app
