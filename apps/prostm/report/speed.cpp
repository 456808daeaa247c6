/// Speed, accuracy and latency of the smoke and the focal points.
#include <algorithm>
#include <cmath>

#include "common.hpp"
#include "prostm/acoustics/focus/focus_solver.hpp"
#include "prostm/core/random.hpp"
#include "prostm/core/stage_timer.hpp"
#include "prostm/device/simulated/simulated_array.hpp"
#include "prostm/hand/hand_raster.hpp"
#include "prostm/pipeline/runner.hpp"
#include "prostm/pipeline/smoke/scene.hpp"
#include "report/report.hpp"

namespace prostm::app {
namespace {

using Json = nlohmann::ordered_json;
using report::Column;

/// Columns of a distribution's quantiles.
std::vector<Column> with_quantiles(std::vector<Column> columns, const char* unit, int digits) {
  for (const char* key : {"p50", "p99", "max"}) columns.push_back({key, key, unit, digits});
  return columns;
}

Json quantiles(Json row, const Summary& summary, double scale) {
  row["p50"] = scale * summary.p50;
  row["p99"] = scale * summary.p99;
  row["max"] = scale * summary.max;
  return row;
}

/// The smoke with one pressure solver and the report's hand.
class SteppedSmoke {
 public:
  SteppedSmoke(const ReportWork& work, const FluidSettings& fluid, WorkerPool& pool)
      : settings_(work.settings("four-plumes")),
        pool_(pool),
        fluid_(fluid, scene_from_name(settings_.scene).smoke, pool),
        hands_(work.hand(settings_)),
        rasteriser_(fluid_.grid()) {}

  void step(bool measured) {
    constexpr double kStep = 0.02;  // [s]
    hands_->sample(kStep * ++steps_, frame_);
    to_device(settings_.X_DT, frame_);
    rasteriser_.rasterise(frame_, pool_);
    const FluidStats stats = fluid_.step(kStep, rasteriser_.raster());
    if (!measured) return;
    time.add(stats.total);
    left.add(stats.divergence_rms);
    largest.add(stats.divergence_max);
    error.add(stats.pressure_error);
  }

  Distribution time, left, largest, error;

 private:
  PipelineSettings settings_;
  WorkerPool& pool_;
  Fluid fluid_;
  std::unique_ptr<HandSource> hands_;
  HandRasteriser rasteriser_;
  HandFrame frame_;
  int steps_ = 0;
};

struct Solver {
  const char* name;
  PressureMethod method;
};
constexpr std::array kSolvers = {
    Solver{"multigrid, 2 V-cycles (prostm)", PressureMethod::Multigrid},
    Solver{"conjugate gradients after multigrid, 3 iterations", PressureMethod::Mgpcg},
    Solver{"40 Jacobi sweeps (the paper's)", PressureMethod::Jacobi}};

/// Four random focal points above the array, at least 15 mm apart.
std::vector<Vec3> random_foci(Random& random) {
  std::vector<Vec3> foci;
  while (foci.size() < 4) {
    const double y = random.uniform(-0.06, 0.06), x = random.uniform(-0.06, 0.06);
    const Vec3 p(x, y, 0.2);
    const bool apart =
        std::ranges::all_of(foci, [&](const Vec3& other) { return (p - other).norm() > 0.015; });
    if (apart) foci.push_back(p);
  }
  return foci;
}

/// The results of one focus solver over all sets.
struct SolverOutcome {
  Distribution error, power, time;
};

Json stage_rows(const RunSummary& summary) {
  Json rows = Json::array();
  for (const StageSummary& stage : stage_summaries())
    rows.push_back(quantiles({{"what", stage.name}}, summary.*stage.times, 1e3));
  return rows;
}

Json part_rows(const RunSummary& summary) {
  Json rows = Json::array();
  for (int part = 0; part < kLatencyParts; ++part) {
    const Summary& of = summary.latency_parts[static_cast<std::size_t>(part)];
    Json row = {{"what", latency_part_name(part)}, {"mean", 1e3 * of.mean}};
    rows.push_back(quantiles(row, of, 1e3));
  }
  Json all = {{"what", "all"}, {"mean", 1e3 * summary.latency.mean}};
  rows.push_back(quantiles(all, summary.latency, 1e3));
  return rows;
}

/// Lets a run continue until its end.
class Watched final : public RunObserver {
 public:
  Watched(const ReportWork& work, double seconds) : work_(work), seconds_(seconds) {}
  bool on_plan(const WorldFrame&, const PlanFrame&) override { return true; }
  bool on_progress(double time) override {
    work_.progress(std::min(1.0, time / seconds_));
    return true;
  }

 private:
  const ReportWork& work_;
  double seconds_;
};

}  // namespace

void make_fluid(const ReportWork& work, Json& document) {
  constexpr int kWarmUp = 50, kTurn = 10;
  const int steps = work.full_or_quick(300, 60, "steps of each solver", document);
  WorkerPool pool(2);
  std::vector<std::unique_ptr<SteppedSmoke>> smokes;
  for (const Solver& solver : kSolvers) {
    FluidSettings settings;
    settings.solver = solver.method;
    smokes.push_back(std::make_unique<SteppedSmoke>(work, settings, pool));
  }
  for (int done = 0; done < kWarmUp + steps; done += kTurn) {
    for (auto& smoke : smokes) {
      for (int i = 0; i < kTurn; ++i) smoke->step(done >= kWarmUp);
    }
    work.progress(static_cast<double>(done) / (kWarmUp + steps));
  }
  Json exactness = Json::array(), times = Json::array();
  for (std::size_t s = 0; s < kSolvers.size(); ++s) {
    const SteppedSmoke& smoke = *smokes[s];
    exactness.push_back({{"solver", kSolvers[s].name},
                         {"left", 100.0 * smoke.left.summary().mean},
                         {"largest", smoke.largest.summary().mean},
                         {"error", 100.0 * smoke.error.summary().mean}});
    times.push_back(quantiles({{"solver", kSolvers[s].name}}, smoke.time.summary(), 1e3));
  }
  document["values"] = {{"steps", steps}, {"cells", FluidSettings{}.cells}};
  document["blocks"].push_back(report::text_block(
      "Steps of 20 ms of four plumes with the report's hand, {/values/cells}³ cells, "
      "{/values/steps} steps of each solver after a start."));
  document["blocks"].push_back(report::table_block(
      "Remaining errors: rms divergence over that before the solve; largest divergence, in cells a "
      "step; and the solver's own estimate of the pressure's error next to the hand, over that "
      "pressure",
      {{"solver", "solver"},
       {"left", "divergence left", "%", 2},
       {"largest", "largest divergence", "1/step", 4},
       {"error", "error beside the hand", "%", 2}},
      exactness));
  document["timing"].push_back(
      report::table_block("Time of a step, on two threads, solvers in turn",
                          with_quantiles({{"solver", "solver"}}, "ms", 2), times));
  report::add_verdicts(document["blocks"],
                       {report::not_comparable("The paper does not say how much divergence its "
                                               "solver leaves, nor how many sweeps it makes.")});
}

void make_solvers(const ReportWork& work, Json& document) {
  const int sets = work.full_or_quick(1000, 100, "sets of focal points", document);
  Random random(static_cast<std::uint64_t>(work.seed));
  const TransducerArray array = usx_array();
  const std::size_t methods = kNames<FocusMethod>.size();
  std::vector<SolverOutcome> outcomes(methods);
  for (int set = 0; set < sets; ++set) {
    const Propagation g = propagation_to(array, Medium{}, random_foci(random));
    const Eigen::VectorXd alone = g.cwiseAbs().rowwise().sum();
    Eigen::VectorXd target = alone;
    for (Eigen::Index i = 0; i < target.size(); ++i) target[i] *= random.uniform(0.25, 1.0);
    for (std::size_t m = 0; m < methods; ++m) {
      FocusSettings settings;
      settings.method = static_cast<FocusMethod>(m);
      const StageTimer timer;
      const FocusSolution solution = solve_foci(g, target, settings);
      outcomes[m].time.add(timer.seconds());
      outcomes[m].error.add(focus_errors(solution, target).cwiseAbs().maxCoeff());
      outcomes[m].power.add((solution.level * target.array() / alone.array()).square().sum());
    }
    work.progress(static_cast<double>(set + 1) / sets);
  }
  Json quality = Json::array(), times = Json::array();
  for (std::size_t m = 0; m < methods; ++m) {
    const std::string name(kNames<FocusMethod>[m]);
    Json row = {{"solver", name}, {"power", outcomes[m].power.summary().mean}};
    quality.push_back(quantiles(row, outcomes[m].error.summary(), 100.0));
    times.push_back(quantiles({{"solver", name}}, outcomes[m].time.summary(), 1e6));
  }
  document["values"] = {{"sets", sets}, {"array", array.name}, {"seed", work.seed}};
  document["blocks"].push_back(report::text_block(
      "Drives of the array {/values/array} for four focal points 200 mm above it, at least 15 mm "
      "apart, with unequal pressures; {/values/sets} random sets with seed {/values/seed}."));
  document["blocks"].push_back(report::table_block(
      "The largest error of a focal point's pressure in a set, over what was asked for; and the "
      "power, the sum of (p over p of that focal point alone)²",
      with_quantiles({{"solver", "solver"}, {"power", "power, mean", "", 3}}, "%", 2), quality));
  document["timing"].push_back(report::table_block(
      "Time of a set by the solvers of files and pictures, one thread (the live "
      "solver of the emission is another, docs/design/acoustics.md)",
      with_quantiles({{"solver", "solver"}}, "µs", 0), times));
  report::add_verdicts(
      document["blocks"],
      {report::not_comparable("The solver of the paper's array is not published.")});
}

void make_latency(const ReportWork& work, Json& document) {
  const double seconds = work.full_or_quick(10.0, 3.0, "s in real time", document);
  PipelineSettings settings = work.settings("four-plumes");
  settings.devices.of<SimulatedArraySettings>().realtime = true;
  settings.scripted_hand.still = true;  // always there
  set_live_budget(settings);
  Pipeline pipeline(settings, work.hand(settings));
  Watched watched(work, seconds);
  RunOptions options;
  options.seconds = seconds;
  const RunSummary summary = run(pipeline, settings, options, watched);
  if (summary.failure) std::rethrow_exception(summary.failure);
  document["values"] = {{"seconds", seconds}};
  document["blocks"].push_back(report::text_block(
      "prostm run in real time for {/values/seconds} s: four plumes, the simulated array, preset "
      "best with a budget of 2 ms. All numbers are times, of this machine and of what else it "
      "did."));
  auto& timing = document["timing"];
  timing.push_back(report::table_block(
      "From a tracker's frame to the first sample planned from it, part by part",
      with_quantiles({{"what", "part"}, {"mean", "mean", "ms", 2}}, "ms", 2), part_rows(summary)));
  timing.push_back(report::table_block(
      "Time of each stage", with_quantiles({{"what", "stage"}}, "ms", 3), stage_rows(summary)));
  Json kept = Json::array();
  for (const auto& [name, count] :
       {std::pair<const char*, std::int64_t>{"steps of the smoke", summary.world_steps},
        {"steps that were skipped", summary.skipped_world_steps},
        {"plans", summary.plans},
        {"blocks of samples", summary.device.blocks},
        {"late blocks", summary.device.late_blocks},
        {"missed blocks", summary.device.missed_blocks}})
    kept.push_back({{"what", name}, {"count", count}});
  timing.push_back(report::table_block("Whether it kept up",
                                       {{"what", "what"}, {"count", "count", "", 0}}, kept));
  report::add_verdicts(timing,
                       {report::not_comparable("The paper gives no latency from hand to sound.")});
}

}  // namespace prostm::app
