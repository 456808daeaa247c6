/// Additional time of a plan whose pressures, or points too, are chosen by the percept; and the
/// time of one evaluation of the percept, compared with plain loops.

#include <fmt/core.h>

#include <Eigen/Core>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "program.hpp"
#include "prostm/core/random.hpp"
#include "prostm/core/stage_timer.hpp"
#include "prostm/felt/felt_loss.hpp"
#include "prostm/fields/fields.hpp"
#include "prostm/plan/planner.hpp"

namespace prostm::bench {
namespace {

constexpr double kSigma = 4.3e-3;  // of the array's focus at 200 mm [m]
constexpr int kPalmCells = 34;     // rows and columns, 4.7 mm apart, for the times of preset felt

PlanSettings settings_of(double felt_weight, bool points) {
  PlanSettings settings;
  settings.sigma = kSigma;
  settings.felt_weight = felt_weight;
  settings.felt_points = points;
  return settings;
}

/// One way to plan, with the time that its plans took [ms].
struct Timed {
  Timed(const PlanSettings& settings, bool is_warm)
      : planner(settings, fields::kCells * fields::kCells), warm(is_warm) {}

  double plan(const TargetField& field) {
    if (!warm) planner.reset();
    StageTimer timer;
    planner.plan(field, out, stats);
    return 1e3 * timer.lap();
  }
  Planner planner;
  bool warm;
  Plan out;
  PlanStats stats;
};

/// Plans sequences in turn without and with the step, and adds the difference in time.
void measure_plans(int frames, bool warm, bool points, std::vector<Row>& rows) {
  Distribution more, plain_times;
  for (const fields::Pattern pattern : fields::kPatterns) {
    Timed plain(settings_of(0.0, false), warm), felt(settings_of(0.9, points), warm);
    for (int frame = 0; frame < frames; ++frame) {
      const TargetField field = fields::make(pattern, frame);
      const double without = plain.plan(field), with = felt.plan(field);
      // the first plan also makes the tables, which are reused
      if (frame == 0) continue;
      plain_times.add(without);
      more.add(with - without);
    }
  }
  rows.push_back({fmt::format("felt/more for a plan, {}, {}", points ? "points" : "pressures",
                              warm ? "warm" : "cold"),
                  "ms", more.summary(), "the plan without it", plain_times.summary().p50});
}

/// Time of plans of preset felt for four plumes, and of those of preset best in turn with them.
/// @param budget of preset felt [s].
void measure_preset(int frames, bool warm, double budget, std::vector<Row>& rows) {
  PlanSettings chosen = settings_of(0.0, false);
  chosen.preset = Preset::Felt;
  chosen.budget = budget;
  Timed best(settings_of(0.0, false), warm), felt(chosen, warm);
  Distribution times, best_times;
  for (int round = 0; round < 2; ++round) {
    for (int frame = 0; frame < frames; ++frame) {
      const TargetField field = fields::make(fields::Pattern::FourPlumes, frame, kPalmCells);
      const double without = best.plan(field), with = felt.plan(field);
      // the first round also makes the tables, which are reused
      if (round == 0) continue;
      best_times.add(without);
      times.add(with);
    }
  }
  const std::string limit =
      budget > 0.0 ? fmt::format("budget of {:.0f} ms", 1e3 * budget) : "no budget";
  rows.push_back({fmt::format("felt/preset felt, {}, {}", warm ? "warm" : "cold", limit), "ms",
                  times.summary(), "preset best", best_times.summary().p50});
}

/// Sources of four paths of 28 points on a hand, as a plan has them.
template <class Real>
std::vector<FeltSource<Real>> sources() {
  Random random(1);
  std::vector<FeltSource<Real>> out(4 * 28);
  for (FeltSource<Real>& source : out) {
    source.x = static_cast<Real>(random.uniform(20.0, 140.0));
    source.y = static_cast<Real>(random.uniform(20.0, 140.0));
    for (Real& part : source.spectrum) part = static_cast<Real>(random.uniform(-1.0, 1.0));
  }
  return out;
}

/// The loss of one target on three skins.
template <class Real>
struct Evaluated {
  explicit Evaluated(const FeltCells& cells)
      : loss(3, kFeltCells, 4 * 28, FeltWeights(), false),
        pressure(4 * 28, Real(0.5)),
        gradient(4 * 28) {
    FeltSkins<Real> skins(3);
    FocusResponseMaker maker;
    for (FocusResponse<Real>& skin : skins)
      maker.make(SkinModel(SkinSettings()), kSigma, 20e-3, skin);
    loss.set_target(cells);
    loss.set_sources(skins, sources<Real>());
  }
  double evaluate() {
    StageTimer timer;
    loss.evaluate(pressure);
    loss.gradient(gradient);
    return 1e3 * timer.lap();
  }
  FeltLoss<Real> loss;
  std::vector<Real> pressure, gradient;
};

/// Time to read this many bytes from the cache and add them up as numbers [ms]: an evaluation reads
/// its pairs twice.
Distribution reading(std::size_t bytes) {
  const Eigen::VectorXf numbers =
      Eigen::VectorXf::Ones(static_cast<Eigen::Index>(bytes / sizeof(float)));
  Distribution out;
  for (int round = 0; round < 200; ++round) {
    StageTimer timer;
    const float sum = numbers.sum();
    out.add(1e3 * timer.lap());
    if (sum <= 0.0F) throw std::logic_error("a sum of ones is not above 0");
  }
  return out;
}

void measure_evaluations(std::vector<Row>& rows) {
  const TargetField field = fields::make(fields::Pattern::FourPlumes, 10);
  FeltCells cells(kFeltCells);
  cells.set(field, max_pressure(field));
  Evaluated<float> fast(cells);
  Evaluated<double> plain(cells);
  Distribution plain_time, fast_time;
  for (int round = 0; round < 200; ++round) plain_time.add(plain.evaluate());
  for (int round = 0; round < 200; ++round) fast_time.add(fast.evaluate());
  const std::size_t pairs = 3 * cells.cells().size() * 4 * 28;
  const Distribution floor = reading(pairs * kFeltParts * sizeof(std::uint16_t));
  fmt::print(
      "{} cells, 112 points, 3 skins: {} pairs of 32 bytes, which an evaluation reads twice\n",
      cells.cells().size(), pairs);
  rows.push_back({"felt/evaluation and gradient", "ms", fast_time.summary(), "plain loops, double",
                  plain_time.summary().p50});
  rows.push_back({"felt/reading as many bytes once", "ms", floor.summary(), "", 0.0});
}

}  // namespace
}  // namespace prostm::bench

int main(int argc, char** argv) {
  using namespace prostm::bench;
  Program program("additional time for choosing pressures by the percept");
  int frames = 25;
  program.option("--frames", frames, "frames of each generated sequence", 2, 100);
  return program.run(argc, argv, [&] {
    std::vector<Row> rows;
    measure_evaluations(rows);
    for (const bool warm : {false, true}) measure_plans(frames, warm, false, rows);
    for (const bool warm : {false, true}) {
      for (const double budget : {4e-3, 10e-3, 20e-3}) measure_preset(100, warm, budget, rows);
      measure_preset(std::min(frames, 12), warm, 0.0, rows);
    }
    measure_plans(std::min(frames, 6), false, true, rows);
    return rows;
  });
}
