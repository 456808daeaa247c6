#include "felt/live.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <numeric>

#include "felt/judge.hpp"
#include "felt/skins.hpp"
#include "felt_time/felt_live.hpp"
#include "prostm/core/worker_pool.hpp"
#include "prostm/fields/fields.hpp"
#include "prostm/plan/detail/fit/felt/path_count.hpp"

namespace prostm::bench {
namespace {

constexpr int kFirst = 40;               // frame of the first target
constexpr std::size_t kLookedApart = 6;  // number of plans that are also judged as loops

/// Judges some plans of the second half of a run as loops: those of the run, and plans made alone.
void judge_loops(const TransducerArray& array, const Way& way, const std::vector<LivePlan>& plans,
                 LiveScores& out) {
  Judge judge(array, plans[0].target, {skins()[0]}, {});
  int count = 0;
  for (std::size_t i = plans.size() / 2; i < plans.size(); i += kLookedApart, ++count) {
    const TargetField& target = plans[i].target;
    out.loop += judge.judge(plans[i].plan, target, 0, true).felt.skill_8;
    out.alone += judge.judge(way.plan(target), target, 0, true).felt.skill_8;
  }
  out.loop /= count;
  out.alone /= count;
}

LiveScores score_run(const TransducerArray& array, const LiveSequence& sequence, const Way& way,
                     SwitchAt switch_at, const TimeSkin& skin) {
  std::vector<LivePlan> plans;
  const Planning planning = way.begin(sequence.targets[0]);
  std::size_t foci = 1;
  for (const TargetField& target : sequence.targets) {
    plans.push_back({planning(target), target});
    foci = std::max({foci, plans.back().plan.paths.size(), plans.back().plan.foci.size()});
  }
  LiveScores out;
  judge_loops(array, way, plans, out);
  LiveSettings settings;
  std::vector<std::size_t> points;
  for (const LivePlan& one : plans) points.push_back(one.plan.paths.size() + one.plan.foci.size());
  const double seconds = static_cast<double>(plans.size()) * settings.interval;
  for (std::size_t i = 1; i < points.size(); ++i)
    out.changes += points[i] != points[i - 1] ? 1.0 / seconds : 0.0;
  out.hasty = count_hasty(points, sequence.targets, settings.interval) / seconds;
  settings.emit.switch_at = switch_at;
  settings.emit.foci = static_cast<int>(foci);
  settings.emit.power_limit = static_cast<double>(foci);  // only the array limits the power
  const auto method = plans[0].plan.foci.empty() ? Method::ProStm : Method::Am;
  WorkerPool pool(1);
  LiveFelt felt;
  felt_live(
      method, plans, settings, array, skin, pool, [](std::size_t, std::size_t) { return true; },
      felt);
  out.live = felt.metrics.skill_8;
  out.window = std::accumulate(felt.window_skill_8.begin(), felt.window_skill_8.end(), 0.0) /
               static_cast<double>(felt.window_skill_8.size());
  out.intensity = felt.intensity;
  out.faded = static_cast<double>(felt.emit.faded) / static_cast<double>(felt.emit.samples);
  return out;
}

double mean(const std::vector<LiveScores>& scores, double LiveScores::*value) {
  double sum = 0.0;
  for (const LiveScores& s : scores) sum += s.*value;
  return sum / static_cast<double>(scores.size());
}

/// @param left share of the gain as a loop that remains live; shown if there is such a gain.
std::string line(const std::vector<LiveScores>& own, const std::vector<LiveScores>& first) {
  const auto of = [&](double LiveScores::*value) { return mean(own, value); };
  const auto more = [&](double LiveScores::*value) { return of(value) - mean(first, value); };
  const auto lack = [&](double LiveScores::*value) {
    return (1.0 - of(value)) / (1.0 - mean(first, value));
  };
  constexpr double kGain = 0.01;
  const auto left = [&](double LiveScores::*value) {
    const double gain = more(&LiveScores::loop);
    return gain > kGain ? fmt::format("{:.2f}", more(value) / gain) : std::string("-");
  };
  return fmt::format(
      "{:>6.3f} {:>6.3f} {:>6.3f} {:>6.2f} {:>6} {:>6.3f} {:>6.2f} {:>6} {:>7.2f} {:>6.3f} "
      "{:>8.2f} {:>6.2f}",
      of(&LiveScores::alone), of(&LiveScores::loop), of(&LiveScores::live), lack(&LiveScores::live),
      left(&LiveScores::live), of(&LiveScores::window), lack(&LiveScores::window),
      left(&LiveScores::window), 1e6 * of(&LiveScores::intensity), of(&LiveScores::faded),
      of(&LiveScores::changes), of(&LiveScores::hasty));
}

}  // namespace

int count_hasty(const std::vector<std::size_t>& points, const std::vector<TargetField>& targets,
                double interval) {
  constexpr double kHold = 1.0;  // [s]
  planning::RegionCounter counter(targets[0].size());
  int hasty = 0, regions = 0;
  bool is_held = false;  // since the last change of the points
  double changed = 0.0;  // time of that change [s]
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double time = static_cast<double>(i) * interval;
    const int now = counter.count(targets[i], max_pressure(targets[i]));
    if (now != regions || time - changed >= kHold) is_held = false;
    regions = now;
    if (i == 0 || points[i] == points[i - 1]) continue;
    hasty += is_held ? 1 : 0;
    is_held = true;
    changed = time;
  }
  return hasty;
}

std::vector<LiveSequence> live_sequences(bool is_still, int most) {
  using fields::Pattern;
  std::vector<LiveSequence> out;
  for (const Pattern pattern :
       {Pattern::FourPlumes, Pattern::Ring, Pattern::Letter, Pattern::Edge, Pattern::Palm}) {
    if (most > 0 && static_cast<int>(out.size()) == most) break;
    LiveSequence& sequence = out.emplace_back();
    sequence.name = fields::to_string(pattern);
    for (int i = 0; i < kLivePlans; ++i)
      sequence.targets.push_back(fields::make(pattern, kFirst + (is_still ? 0 : i), kLiveCells));
  }
  return out;
}

LiveSet score_live(const std::string& name, const TransducerArray& array,
                   const std::vector<LiveSequence>& sequences, const std::vector<Way>& ways,
                   SwitchAt switch_at, int threads) {
  LiveSet set{name, {}, {}, {}};
  for (const Way& way : ways) set.ways.push_back(way.name);
  for (const LiveSequence& sequence : sequences) set.sequences.push_back(sequence.name);
  set.scores.assign(ways.size(), std::vector<LiveScores>(sequences.size()));
  const TargetField& raster = sequences.at(0).targets.at(0);
  const TimeSkin skin(SkinModel(SkinSettings()), {raster.rows, raster.cols, raster.cell});
  const std::size_t runs = ways.size() * sequences.size();
  std::vector<std::exception_ptr> failed(runs);
  std::atomic<std::size_t> next{0};
  WorkerPool pool(threads);
  pool.run(threads, [&](int) {
    for (std::size_t i = next++; i < runs; i = next++) {
      const std::size_t w = i % ways.size(), s = i / ways.size();
      try {
        set.scores[w][s] = score_run(array, sequences[s], ways[w], switch_at, skin);
      } catch (...) {
        failed[i] = std::current_exception();
      }
    }
  });
  for (const std::exception_ptr& error : failed) {
    if (error) std::rethrow_exception(error);
  }
  return set;
}

void print_live(const LiveSet& set, bool each) {
  fmt::print(
      "\n{}, {} sequences: S_8.5 of √e, plans alone and of the run as loops, then in a live run "
      "against the mean target,\nand each 40 ms against its own. lack: 1 - S_8.5 over that of {}. "
      "left: share of the gain of loops over it.\nchanges: of the number of focal points, per "
      "second; hasty: within a second\nof another, without a change of the number of regions"
      "\n{:<20} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6} {:>7} {:>6} {:>8} {:>6}\n",
      set.name, set.sequences.size(), set.ways[0], "", "alone", "loops", "live", "lack", "left",
      "40 ms", "lack", "left", "√E µm", "faded", "changes", "hasty");
  for (std::size_t w = 0; w < set.ways.size(); ++w)
    fmt::print("{:<20} {}\n", set.ways[w], line(set.scores[w], set.scores[0]));
  if (!each) return;
  for (std::size_t s = 0; s < set.sequences.size(); ++s) {
    fmt::print("{}, {}\n", set.name, set.sequences[s]);
    for (std::size_t w = 0; w < set.ways.size(); ++w)
      fmt::print("{:<20} {}\n", set.ways[w], line({set.scores[w][s]}, {set.scores[0][s]}));
  }
}

void add_live_rows(const LiveSet& set, std::vector<Row>& rows) {
  const auto lack = [&](std::size_t w, double LiveScores::*value) {
    Distribution out;
    for (const LiveScores& s : set.scores[w]) out.add(1.0 - s.*value);
    return out.summary();
  };
  for (std::size_t w = 0; w < set.ways.size(); ++w) {
    const auto add = [&](const std::string& what, double LiveScores::*value) {
      rows.push_back({fmt::format("felt/{}/{}/1 - S_8.5, {}", set.name, set.ways[w], what), "",
                      lack(w, value), w == 0 ? "" : set.ways[0],
                      w == 0 ? 0.0 : lack(0, value).p50});
    };
    add("live", &LiveScores::live);
    add("loops", &LiveScores::loop);
  }
}

}  // namespace prostm::bench
