#include "run_summary.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common.hpp"
#include "prostm/io/quantity_json.hpp"

namespace prostm::app {
namespace {

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
  if (settings.method == Method::ProStm) {
    fmt::print(out, "  laps completed {:.1f} %, switches: {}\n", 100.0 * laps_completed(s.emit),
               name_of(settings.emit.switch_at));
  }
  for (const StageSummary& stage : stage_summaries()) row(stage.name, s.*stage.times);
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
  nlohmann::ordered_json json = {
      {"format", "prostm-run/1"},
      {"scene", settings.scene},
      {"method", name_of(settings.method)},
      {"switch_at", name_of(settings.emit.switch_at)},
      {"stopped", s.stopped},
      {"failure", s.failure ? nlohmann::ordered_json(sentence_of(s.failure))
                            : nlohmann::ordered_json(nullptr)}};
  json.update(quantities_to_json(s));
  json.update(quantities_to_json(s.device));
  json.update(quantities_to_json(s.emit));
  json.update(quantities_to_json(s.contact_stats));
  json["latency_ms"] = to_json(s.latency, 1e3);
  json["latency_parts_ms"] = parts_json(s.latency_parts);
  json["redraw_ms"] = to_json(s.redraw, 1e3);
  for (const StageSummary& stage : stage_summaries())
    json["stage_ms"][stage.name] = to_json(s.*stage.times, 1e3);
  return json;
}

void print_summary(std::FILE* out, const RunSummary& s, const PipelineSettings& settings) {
  fmt::print(out,
             "{}: {:.1f} s, {} fluid steps ({} skipped), {} plans ({} updates without pressure, {} "
             "skipped)\n",
             settings.scene, s.seconds, s.world_steps, s.skipped_world_steps, s.plans,
             s.empty_updates, s.skipped_updates);
  fmt::print(out, "device: {} blocks, {} late, {} missed, queue of {} blocks\n", s.device.blocks,
             s.device.late_blocks, s.device.missed_blocks, s.device.queue_blocks);
  if (s.limited_samples > 0) {
    fmt::print(out, "device: {} samples were outside its limits and cut down\n", s.limited_samples);
  }
  if (settings.method == Method::Am) {
    fmt::print(out,
               "foci: at most {}, {} at {:g} Hz; largest step of one that sounds {:.3f} mm, {} "
               "beyond the focal points\n",
               settings.am.foci, name_of(settings.emit.am_waveform), settings.emit.am_frequency,
               s.emit.max_focus_step * 1e3, s.emit.dropped_paths);
  } else {
    print_paths(out, s);
  }
  fmt::print(out, "drive: full scale {:.3f} Pa, {} of {} samples saturated, {} power-limited\n",
             s.full_scale_pressure, s.emit.saturated, s.emit.samples, s.emit.limited);
  fmt::print(out, "fluid: {:.2g} of the divergence left on the mean\n", s.mean_divergence);
  if (s.contact_stats.joints_outside > 0) {
    fmt::print(
        out,
        "hand: {} joint positions were outside the smoke's box; the skin there has no target\n",
        s.contact_stats.joints_outside);
  }
  if (s.contact_stats.steep_cells > 0) {
    fmt::print(out,
               "hand: {:.0f} % of its skin was too steep for the array to press on, and not "
               "planned\n",
               100.0 * steep_share(s.contact_stats));
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
