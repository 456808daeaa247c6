/// Latency from a tracker's frame to the first sample planned from it, in real time, measured in
/// turn for prostm with switches at lap ends, with switches at once, and for the paper's
/// arrangement of the same stages. For comparison: how late the machine wakes a thread that has
/// nothing to do.
///
/// usage: latency_bench [--json FILE] [--hand FILE] [--scene S] [--seconds S] [--rounds N]

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "program.hpp"
#include "prostm/io/hand/hand_file.hpp"
#include "prostm/pipeline/runner.hpp"

namespace prostm {
namespace {

struct Options {
  std::string hand = "../shared/data/hands/flapping.hands.jsonl", scene = "one-plume";
  double seconds = 15.0;  // duration of each run [s]
  int rounds = 3;
};

/// One arrangement of the stages, and the results of its runs.
struct Arrangement {
  std::string name;
  PipelineSettings settings;
  RunOptions options;
  std::vector<RunSummary> runs;
};

Arrangement ours(const Options& given, SwitchAt switch_at) {
  Arrangement a;
  a.name = "switch " + std::string(name_of(switch_at));
  a.settings.scene = given.scene;
  a.settings.emit.switch_at = switch_at;
  set_live_budget(a.settings);
  a.options.seconds = given.seconds;
  return a;
}

/// The paper's arrangement: the fluid at 50 Hz with 40 Jacobi sweeps, each step computed as a whole
/// after its hands, which are the newest available; plans at 25 Hz that take 24 ms, approximated by
/// preset best with that budget; switches at lap ends; the same queue.
Arrangement papers(const Options& given) {
  Arrangement a = ours(given, SwitchAt::Lap);
  a.name = "the paper's";
  a.settings.fluid.solver = PressureMethod::Jacobi;
  a.settings.plan.budget = 24e-3;
  a.settings.frame_wait = 0.0;
  a.options.prepare_early = false;
  return a;
}

class NoObserver final : public RunObserver {
 public:
  bool on_plan(const WorldFrame&, const PlanFrame&) override { return true; }
  bool on_progress(double) override { return true; }
};

RunSummary run_once(const Arrangement& a, const Options& given) {
  auto hands = given.hand == "scripted"
                   ? make_scripted_hand(a.settings.scripted_hand, a.settings.track)
                   : make_replayed_hand(read_hand_recording(given.hand), a.settings.track, true,
                                        1.0 / a.settings.world_rate);
  Pipeline pipeline(a.settings, std::move(hands));
  NoObserver observer;
  const RunSummary summary = run(pipeline, a.settings, a.options, observer);
  if (summary.failure) std::rethrow_exception(summary.failure);
  return summary;
}

/// Adds how late a thread wakes [ms] that sleeps until each next millisecond, alone on the machine:
/// a lower bound for every arrangement.
void add_wake_ups(double seconds, Distribution& late) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kPeriod{1};
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  for (auto due = Clock::now() + kPeriod; due < end; due = std::max(due + kPeriod, Clock::now())) {
    std::this_thread::sleep_until(due);
    late.add(std::chrono::duration<double, std::milli>(Clock::now() - due).count());
  }
}

/// Returns the median over the runs.
double middle(const Arrangement& a, const std::function<double(const RunSummary&)>& figure) {
  std::vector<double> values;
  values.reserve(a.runs.size());
  for (const RunSummary& run : a.runs) values.push_back(figure(run));
  return quantile(values, 0.5);
}

double laps_completed(const RunSummary& run) {
  return 1.0 - static_cast<double>(run.emit.laps_cut) /
                   static_cast<double>(std::max<std::int64_t>(1, run.emit.laps_started));
}

/// Combines a distribution over the runs [ms]: medians of the quantiles, and the overall maximum.
Summary over_runs(const Arrangement& a,
                  const std::function<const Summary&(const RunSummary&)>& of) {
  Summary all;
  for (const RunSummary& run : a.runs) {
    all.n += of(run).n;
    all.max = std::max(all.max, 1e3 * of(run).max);
  }
  all.mean = middle(a, [&](const RunSummary& run) { return 1e3 * of(run).mean; });
  all.p50 = middle(a, [&](const RunSummary& run) { return 1e3 * of(run).p50; });
  all.p99 = middle(a, [&](const RunSummary& run) { return 1e3 * of(run).p99; });
  return all;
}

void print_runs(const Arrangement& a) {
  for (const RunSummary& run : a.runs) {
    fmt::print("{:<14} {:>7.1f} {:>7.1f} {:>7.1f} {:>9.1f} {:>7.1f} {:>9.1f} {:>6} {:>7} {:>8}\n",
               a.name, 1e3 * run.latency.p50, 1e3 * run.latency.p99, 1e3 * run.latency.max,
               1e3 * run.redraw.p50, 1e3 * run.redraw.p99, 100.0 * laps_completed(run),
               run.device.late_blocks, run.device.missed_blocks, run.skipped_world_steps);
  }
}

void print_parts(const std::vector<Arrangement>& arrangements) {
  fmt::print("\nmean of each part [ms]\n{:<14}", "");
  for (int part = 0; part < kLatencyParts; ++part) fmt::print(" {:>9}", latency_part_name(part));
  fmt::print("\n");
  for (const Arrangement& a : arrangements) {
    fmt::print("{:<14}", a.name);
    for (std::size_t part = 0; part < kLatencyParts; ++part) {
      fmt::print(" {:>9.2f}",
                 middle(a, [&](const RunSummary& r) { return 1e3 * r.latency_parts[part].mean; }));
    }
    fmt::print("\n");
  }
}

std::vector<bench::Row> measure_latency(Options given) {
  if (given.hand != "scripted" && !std::filesystem::exists(given.hand)) {
    fmt::print("{} not found: using the scripted hand instead\n", given.hand);
    given.hand = "scripted";
  }
  std::vector<Arrangement> arrangements = {ours(given, SwitchAt::Lap), ours(given, SwitchAt::Now),
                                           papers(given)};
  Distribution wake_ups;
  for (int round = 0; round < given.rounds; ++round) {
    add_wake_ups(0.2 * given.seconds, wake_ups);
    for (Arrangement& a : arrangements) a.runs.push_back(run_once(a, given));
  }

  fmt::print("{:<14} {:>23} {:>17} {:>9} {:>14} {:>8}\n", "", "latency [ms]", "redraw [ms]", "laps",
             "blocks", "steps");
  fmt::print("{:<14} {:>7} {:>7} {:>7} {:>9} {:>7} {:>9} {:>6} {:>7} {:>8}\n", "", "p50", "p99",
             "max", "p50", "p99", "whole %", "late", "missed", "skipped");
  for (const Arrangement& a : arrangements) print_runs(a);
  print_parts(arrangements);

  std::vector<bench::Row> rows;
  const Arrangement& other = arrangements.back();
  const auto latency = [](const RunSummary& r) -> const Summary& { return r.latency; };
  const auto redraw = [](const RunSummary& r) -> const Summary& { return r.redraw; };
  for (const Arrangement& a : arrangements) {
    const bool beside = &a != &other;
    const std::string baseline = beside ? other.name : "";
    rows.push_back({"latency, " + a.name, "ms", over_runs(a, latency), baseline,
                    beside ? over_runs(other, latency).p50 : 0.0});
    rows.push_back({"redraw, " + a.name, "ms", over_runs(a, redraw), baseline,
                    beside ? over_runs(other, redraw).p50 : 0.0});
    Distribution laps, missed;
    for (const RunSummary& run : a.runs) {
      laps.add(100.0 * laps_completed(run));
      missed.add(static_cast<double>(run.device.missed_blocks));
    }
    rows.push_back({"laps completed, " + a.name, "%", laps.summary(), "", 0.0});
    rows.push_back({"missed blocks, " + a.name, "", missed.summary(), "", 0.0});
  }
  rows.push_back({"an idle machine's wake-ups, late by", "ms", wake_ups.summary(), "", 0.0});
  return rows;
}

}  // namespace
}  // namespace prostm

int main(int argc, char** argv) {
  prostm::bench::Program program(
      "The latency from a tracker's frame to the first sample planned from it.");
  prostm::Options given;
  program.option("--hand", given.hand, "a recording, or scripted");
  program.option("--scene", given.scene, "scene of the fluid");
  program.option("--seconds", given.seconds, "duration of each run [s]", 1.0, 3600.0);
  program.option("--rounds", given.rounds, "rounds of all three arrangements in turn", 1, 1000);
  return program.run(argc, argv, [&] { return prostm::measure_latency(given); });
}
