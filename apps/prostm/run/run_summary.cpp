#include "run/run_summary.hpp"

#include <fmt/format.h>

#include <array>
#include <string>

#include "common.hpp"
#include "prostm/io/quantity_json.hpp"

namespace prostm::app {
namespace {

/// Prints a line of the counts: the stage and its text.
void print_row(std::FILE* out, const char* stage, const std::string& text) {
  fmt::print(out, "  {:<8} {}\n", stage, text);
}

double percent(std::int64_t part, std::int64_t all) {
  return all > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(all) : 0.0;
}

void print_paths(std::FILE* out, const RunSummary& s, const PipelineSettings& settings) {
  print_row(
      out, "paths",
      fmt::format("longest {:.1f} mm in the plane and {:.1f} mm on the skin; {} too long, {} "
                  "crossings",
                  s.max_path_length * 1e3, s.max_skin_length * 1e3, s.long_paths, s.crossings));
  print_row(out, "laps",
            fmt::format("{:.1f} % completed; --switch {}", 100.0 * laps_completed(s.emit),
                        name_of(settings.emit.switch_at)));
  if (s.lap.n == 0) return;
  print_row(
      out, "played",
      fmt::format("focal points at {:.2f} m/s (median), laps of {:.1f} ms (median) to {:.1f} ms",
                  s.focus_speed.p50, 1e3 * s.lap.p50, 1e3 * s.lap.max));
}

void print_foci(std::FILE* out, const RunSummary& s, const PipelineSettings& settings) {
  print_row(out, "foci",
            fmt::format("at most {}, {} at {:g} Hz; {} beyond the focal points", settings.am.foci,
                        name_of(settings.emit.am_waveform), settings.emit.am_frequency,
                        s.emit.dropped_paths));
}

/// Returns the means of the world's own quantities, in words: "; on average …", or nothing.
std::string world_words(const RunSummary& s) {
  std::string words;
  for (std::size_t q = 0; q < s.world_quantities.size(); ++q) {
    const WorldQuantity& quantity = s.world_quantities[q];
    std::string clause = quantity.words;
    if (clause.empty()) {
      clause = fmt::format("{} {{}}{}{}", quantity.name, *quantity.unit == '\0' ? "" : " ",
                           quantity.unit);
    }
    const std::size_t at = clause.find("{}");
    if (at != std::string::npos)
      clause.replace(at, 2, fmt::format("{:.2g}", quantity.words_scale * s.world_means[q]));
    words += (q == 0 ? "; on average " : ", and ") + clause;
  }
  return words;
}

/// Prints the largest levels, unless nothing was emitted.
void print_levels(std::FILE* out, const RunSummary& s) {
  const SafetyStats& levels = s.safety;
  if (levels.acoustic_high <= 0.0) return;
  print_row(
      out, "levels",
      fmt::format("peak at a focal point about {:.2g} kPa rms of sound ({:.2g} to {:.2g}), "
                  "about {:.0f} Pa of radiation pressure on the skin ({:.0f} to {:.0f}); at "
                  "the head about {:.0f} dB ({:.0f} to {:.0f}), {:.0f} dB for the cap "
                  "(docs/devices/safety.md); {:.1f} % weakened by caps, {:.1f} % by ramps",
                  1e-3 * levels.acoustic_likely, 1e-3 * levels.acoustic_low,
                  1e-3 * levels.acoustic_high, levels.radiation_likely, levels.radiation_low,
                  levels.radiation_high, levels.head_likely, levels.head_low, levels.head_bound,
                  levels.head_estimate, percent(capped_samples(levels), s.emit.samples),
                  percent(levels.ramp, s.emit.samples)));
}

void print_output(std::FILE* out, const RunSummary& s) {
  const EmitStats& e = s.emit;
  print_row(out, "samples",
            fmt::format(
                "{} of all focal points; {:.1f} % at full scale ({:.3g} Pa of the target; stronger "
                "pressure feels no stronger), {:.1f} % "
                "weakened by the power limit; largest step {:.3f} mm",
                e.samples, percent(e.saturated, e.samples), s.full_scale_pressure,
                percent(e.limited, e.samples), e.max_focus_step * 1e3));
  print_row(
      out, "array",
      fmt::format("{}: {} blocks of {:.3g} ms; {} missed (dropouts), {} late (absorbed by the "
                  "queue unless missed); queue of {} blocks at the end",
                  s.played_by.name, s.device.blocks, 1e3 * s.played_by.block_time(),
                  s.device.missed_blocks, s.device.late_blocks, s.device.queue_blocks));
  if (s.device.lost_links > 0 || s.device.slow_blocks > 0)
    print_row(out, "link",
              fmt::format("lost {} times, {:.1f} s in total; {} blocks missed because it was slow",
                          s.device.lost_links,
                          static_cast<double>(s.device.lost_blocks) * s.played_by.block_time(),
                          s.device.slow_blocks));
  print_levels(out, s);
  if (s.limited_samples > 0)
    print_row(out, "array", fmt::format("{} samples outside its limits", s.limited_samples));
}

void print_counts(std::FILE* out, const RunSummary& s, const PipelineSettings& settings,
                  const std::string& stopped_by) {
  fmt::print(out, "\nThe run: {}, {:.1f} s{}\n", settings.scene, s.seconds,
             !s.stopped           ? ""
             : stopped_by.empty() ? ", cut short"
                                  : ", cut short by " + stopped_by);
  print_row(
      out, settings.world.c_str(),
      fmt::format("{} steps, {} skipped{}", s.world_steps, s.skipped_world_steps, world_words(s)));
  print_row(out, "plans",
            fmt::format("{}, and {} updates without pressure on a hand; {} targets skipped",
                        s.plans, s.empty_updates, s.skipped_updates));
  if (settings.method == Method::Am) {
    print_foci(out, s, settings);
  } else {
    print_paths(out, s, settings);
  }
  const std::string felt = felt_words(settings);
  if (!felt.empty()) print_row(out, "felt", felt);
  print_output(out, s);
  const ContactStats& c = s.contact_stats;
  print_row(
      out, "hand",
      fmt::format("{:.1f} % of its joints outside the {}'s box; {:.0f} % of its skin too "
                  "steep to press on",
                  percent(c.joints_outside, c.joints), settings.world, 100.0 * steep_share(c)));
  if (s.judged_updates > 0)
    print_row(out, "stimulus",
              fmt::format("as a study needs it in {:.0f} % of the updates (docs/guides/hands.md)",
                          percent(s.passed_updates, s.judged_updates)));
  if (s.unobserved > 0) print_row(out, "record", fmt::format("{} updates missing", s.unobserved));
}

void print_tracker(std::FILE* out, const TrackerStatus& tracker) {
  print_row(out, "tracker",
            fmt::format("{} frames, {} dropped, {} repeated, {} reconnects; hands not taken: {} "
                        "dropped, {} unsure, {} frozen; at the end {}connected",
                        tracker.frames, tracker.dropped, tracker.repeated, tracker.reconnects,
                        tracker.dropped_hands, tracker.unsure, tracker.frozen,
                        tracker.connected ? "" : "not "));
}

void print_reading(std::FILE* out, const HandReading& reading) {
  const HandFaults& faults = reading.faults;
  print_row(out, "file",
            fmt::format("{} frames, {} dropped; {} hands, {} dropped{}", reading.frames,
                        faults.frames(), reading.hands, faults.hands(),
                        faults.any() ? fmt::format(" ({})", causes_of(faults)) : std::string()));
}

nlohmann::ordered_json faults_json(const std::array<std::int64_t, kHandFaults>& count) {
  nlohmann::ordered_json json;
  for (std::size_t f = 0; f < kHandFaults; ++f)
    json[std::string(name_of(static_cast<HandFault>(f)))] = count[f];
  return json;
}

/// Prints the heading of a table of times.
void print_heading(std::FILE* out) {
  fmt::print(out, "  [ms]               mean      p50      p99      max\n");
}
void print_times(std::FILE* out, const std::string& name, const Summary& t,
                 const std::string& meaning) {
  fmt::print(out, "  {:<14} {:>8} {:>8} {:>8} {:>8}  {}\n", name, thousandths(t.mean * 1e3),
             thousandths(t.p50 * 1e3), thousandths(t.p99 * 1e3), thousandths(t.max * 1e3), meaning);
}

/// Meaning of each LatencyPart.
constexpr std::array<const char*, kLatencyParts> kPartMeanings = {
    "the frame waits for the next step",
    "the step begins late",
    "the hand is filtered and rasterised on the grid",
    "the smoke meets the hand; the rest of its step was done before",
    "the target is made",
    "the planner wakes up",
    "the plan is made",
    "it is laid on the skin",
    "the device asks for a block (negative: late)",
    "the lap that is being drawn ends",
    "the device plays what was queued before, and passes it on"};

/// Prints the device's part of the latency: the time between its blocks, and its queue.
void print_share_of_device(std::FILE* out, const RunSummary& s) {
  const double block = s.latency_parts[kBlockWait].mean, queue = s.latency_parts[kQueuePart].mean;
  fmt::print(out,
             "  {} adds {:.1f} ms on average: {:.1f} until it asks for its next block of {:.3g} "
             "ms, {:.1f} in its queue\n",
             s.played_by.name, 1e3 * (block + queue), 1e3 * block, 1e3 * s.played_by.block_time(),
             1e3 * queue);
}

void print_latency(std::FILE* out, const RunSummary& s) {
  if (s.latency.n == 0) return;
  fmt::print(out,
             "\nLatency, from the tracker's frame to the first sample planned from it: of {} plans "
             "that were played by {}\n",
             s.latency.n, s.played_by.name);
  print_heading(out);
  print_times(out, "latency", s.latency, "the sum of these parts:");
  for (int part = 0; part < kLatencyParts; ++part) {
    const auto i = static_cast<std::size_t>(part);
    const Summary& times = s.latency_parts[i];
    // without a clock a computation takes no time
    if (times.mean == 0.0 && times.max == 0.0) continue;
    print_times(out, fmt::format("  {}", latency_part_name(part)), times, kPartMeanings[i]);
  }
  print_times(out, "redraw", s.redraw, "until 90 % of the new paths were drawn");
  if (s.mode == RunMode::RealTime) print_share_of_device(out, s);
}

void print_stages(std::FILE* out, const RunSummary& s) {
  fmt::print(out, "\nComputing time of each stage, each time it ran, without waiting\n");
  print_heading(out);
  for (const StageSummary& stage : stage_summaries()) {
    const Summary& times = s.*stage.times;
    print_times(out, stage.name, times, fmt::format("{} times", times.n));
  }
}

nlohmann::ordered_json parts_json(const std::array<Summary, kLatencyParts>& parts) {
  nlohmann::ordered_json json;
  for (int part = 0; part < kLatencyParts; ++part) {
    json[latency_part_name(part)] = to_json(parts[static_cast<std::size_t>(part)], 1e3);
  }
  return json;
}

/// Returns the numbers of the run; the means of the world's own quantities precede its resets.
nlohmann::ordered_json run_json(const RunSummary& s) {
  nlohmann::ordered_json json;
  const nlohmann::ordered_json numbers = quantities_to_json(s);
  for (const auto& [name, value] : numbers.items()) {
    if (name == "world_resets") {
      for (std::size_t q = 0; q < s.world_quantities.size(); ++q)
        json[s.world_quantities[q].name] = s.world_means[q];
    }
    json[name] = value;
  }
  return json;
}

nlohmann::ordered_json verdict_json(const Verdict& verdict) {
  nlohmann::ordered_json held = nullptr;
  if (verdict.held) held = *verdict.held;
  return {{"held", held}, {"sentences", verdict.sentences}};
}

}  // namespace

nlohmann::ordered_json summary_json(const RunSummary& s, const PipelineSettings& settings,
                                    const Verdict& verdict) {
  nlohmann::ordered_json json = {
      {"format", "prostm-run/1"},
      {"verdict", verdict_json(verdict)},
      {"mode", name_of(s.mode)},
      {"scene", settings.scene},
      {"method", name_of(settings.method)},
      {"switch_at", name_of(settings.emit.switch_at)},
      {"device", device_json(s.played_by)},
      {"stopped", s.stopped},
      {"failure", s.failure ? nlohmann::ordered_json(sentence_of(s.failure))
                            : nlohmann::ordered_json(nullptr)}};
  json.update(run_json(s));
  json.update(quantities_to_json(s.device));
  json.update(quantities_to_json(s.emit));
  json.update(quantities_to_json(s.safety));
  json.update(quantities_to_json(s.contact_stats));
  json["lap_ms"] = to_json(s.lap, 1e3);
  json["focus_speed_m_s"] = to_json(s.focus_speed, 1.0);
  json["latency_ms"] = to_json(s.latency, 1e3);
  json["latency_parts_ms"] = parts_json(s.latency_parts);
  json["redraw_ms"] = to_json(s.redraw, 1e3);
  for (const StageSummary& stage : stage_summaries())
    json["stage_ms"][stage.name] = to_json(s.*stage.times, 1e3);
  return json;
}

void print_summary(std::FILE* out, const RunSummary& s, const PipelineSettings& settings,
                   const Verdict& verdict, const std::optional<TrackerStatus>& tracker,
                   const HandReading* reading, const std::string& stopped_by) {
  for (const std::string& sentence : verdict.sentences) fmt::print(out, "{}\n", sentence);
  print_counts(out, s, settings, stopped_by);
  if (tracker) print_tracker(out, *tracker);
  if (reading != nullptr) print_reading(out, *reading);
  print_latency(out, s);
  print_stages(out, s);
}

nlohmann::ordered_json tracker_json(const std::optional<TrackerStatus>& tracker) {
  if (!tracker) return nullptr;
  return {{"connected", tracker->connected},
          {"frames", tracker->frames},
          {"dropped", tracker->dropped},
          {"dropped_hands", tracker->dropped_hands},
          {"faults", faults_json(tracker->faults)},
          {"repeated", tracker->repeated},
          {"unsure", tracker->unsure},
          {"frozen", tracker->frozen},
          {"reconnects", tracker->reconnects},
          {"sentence", tracker->sentence}};
}

nlohmann::ordered_json reading_json(const HandReading* reading) {
  if (reading == nullptr) return nullptr;
  const HandFaults& faults = reading->faults;
  return {{"frames", reading->frames},
          {"dropped", faults.frames()},
          {"hands", reading->hands},
          {"dropped_hands", faults.hands()},
          {"faults", faults_json(faults.count)},
          {"first", faults.any() ? nlohmann::ordered_json(faults.first) : nullptr}};
}

}  // namespace prostm::app
