#include "planner/nlopt_baseline.hpp"

#include <fmt/core.h>

#ifdef PROSTM_WITH_NLOPT

#include <nlopt.h>

#include <cmath>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "planner/sequences.hpp"
#include "prostm/core/stage_timer.hpp"
#include "prostm/plan/detail/fit/descent.hpp"
#include "prostm/plan/detail/fit/fit_settings.hpp"
#include "prostm/plan/detail/fit/initial_loops.hpp"
#include "prostm/plan/detail/fit/raster/cell_tiles.hpp"
#include "prostm/plan/detail/paper/refine.hpp"
#include "prostm/plan/detail/tours.hpp"
#include "prostm/plan/planner.hpp"

namespace prostm::bench {
namespace {

using namespace planning;

constexpr double kFitWidth = 4.0;    // width of the cells used for starts [mm]
constexpr int kFitEvaluations = 30;  // per start of preset best

template <typename Visit>
void for_samples(const Loops& loops, const Visit& visit) {
  for (int k = 0; k < loops.paths; ++k) {
    for (int i = 0; i < loops.samples; ++i) visit(i, k);
  }
}

/// Returns preset paper's paths before refinement [mm from the raster's origin].
std::vector<Vec2> starting_paths(const TargetField& target, const PlanSettings& settings,
                                 Planner& planner) {
  Plan plan;
  PlanStats stats;
  PlanTrace trace;
  planner.plan(target, plan, stats, &trace);
  Clusters clusters;
  for (std::size_t c = 0; c < trace.clusters.size(); ++c) {
    clusters.centre.push_back(kMmPerMetre * (trace.clusters[c] - target.origin));
    clusters.mass.push_back(trace.cluster_mass[c]);
  }
  const auto n = static_cast<std::size_t>(settings.samples);
  std::vector<Vec2> x(trace.split.size() * n);
  for (std::size_t k = 0; k < trace.split.size(); ++k) {
    const Tour tour(trace.split[k].begin(), trace.split[k].end());
    resample_tour(clusters, std::span<const std::uint8_t>(tour.data(), tour.size()),
                  std::span<Vec2>(x).subspan(k * n, n));
  }
  return x;
}

/// A cost of coordinates x0, y0, x1, y1, …; fills the gradient.
using Cost = std::function<double(std::span<const double> x, std::span<double> gradient)>;

struct Counted {
  const Cost& cost;
  std::vector<double> gradient;
  int evaluations = 0;
};

double counted_cost(unsigned n, const double* x, double* gradient, void* data) {
  auto& counted = *static_cast<Counted*>(data);
  ++counted.evaluations;
  const std::span<double> into(gradient != nullptr ? gradient : counted.gradient.data(), n);
  return counted.cost({x, n}, into);
}

struct Minimum {
  double cost = 0.0, seconds = 0.0;
  int evaluations = 0;
};

/// Runs L-BFGS to convergence, then `restarts` more times from the point it reached.
Minimum with_nlopt(const Cost& cost, std::vector<double> x, double tolerance, int restarts) {
  const auto n = static_cast<unsigned>(x.size());
  Counted counted{cost, std::vector<double>(n)};
  const std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> opt(nlopt_create(NLOPT_LD_LBFGS, n),
                                                              nlopt_destroy);
  nlopt_set_min_objective(opt.get(), counted_cost, &counted);
  // stored pairs; NLopt's own choice takes 15 times as long
  nlopt_set_vector_storage(opt.get(), 10);
  nlopt_set_ftol_rel(opt.get(), tolerance);
  nlopt_set_maxeval(opt.get(), 50'000);
  Minimum minimum;
  const StageTimer timer;
  for (int run = 0; run <= restarts; ++run) {
    // when its line search gains no more, NLopt reports a failure but keeps the best point: the
    // costs have kinks
    nlopt_optimize(opt.get(), x.data(), &minimum.cost);
  }
  minimum.seconds = timer.seconds();
  minimum.cost = cost(x, counted.gradient);
  minimum.evaluations = counted.evaluations;
  return minimum;
}

/// Returns (P6) in NLopt's form.
Cost papers_cost(const PressureRaster& raster, const PlanSettings& settings) {
  const auto refiner =
      std::make_shared<Refiner>(CostSettings(settings), settings.paths, settings.samples, 0);
  return [&raster, refiner, points = std::vector<Vec2>(), slope = std::vector<Vec2>()](
             std::span<const double> x, std::span<double> gradient) mutable {
    points.resize(x.size() / 2);
    slope.resize(x.size() / 2);
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = Vec2(x[2 * i], x[2 * i + 1]);
    const double value = refiner->evaluate(raster, points, slope);
    for (std::size_t i = 0; i < points.size(); ++i) {
      gradient[2 * i] = slope[i].x();
      gradient[2 * i + 1] = slope[i].y();
    }
    return value;
  };
}

std::vector<double> coordinates(const std::vector<Vec2>& points) {
  std::vector<double> x;
  for (const Vec2& p : points) x.insert(x.end(), {p.x(), p.y()});
  return x;
}

Minimum with_descent(const PressureRaster& raster, const PlanSettings& settings,
                     std::vector<Vec2> x, int iterations) {
  Refiner refiner(CostSettings(settings), settings.paths, settings.samples, iterations);
  Minimum minimum;
  const StageTimer timer;
  const RefineResult result = refiner.run(raster, x);
  minimum.seconds = timer.seconds();
  minimum.cost = result.cost;
  minimum.evaluations = result.evaluations;
  return minimum;
}

/// Returns (P11)–(P15) in NLopt's form.
Cost fit_cost(const CellTiles& cells, Descent& descent, const Loops& start) {
  return [&cells, &descent, fit = Fit{start, {}, 0.0F}](std::span<const double> x,
                                                        std::span<double> gradient) mutable {
    std::size_t i = 0;
    for_samples(fit.loops, [&](int sample, int path) {
      fit.loops.set_point(sample, path, Vec2(x[i], x[i + 1]));
      i += 2;
    });
    descent.evaluate(cells, fit);
    i = 0;
    for_samples(fit.loops, [&](int sample, int path) {
      const std::size_t node = fit.loops.node(sample, path);
      gradient[i] = static_cast<double>(fit.reconstruction.gradient_x[node]);
      gradient[i + 1] = static_cast<double>(fit.reconstruction.gradient_y[node]);
      i += 2;
    });
    return static_cast<double>(fit.cost);
  };
}

/// Runs the descent of preset best; with `again`, restarts it until it gains no more.
Minimum with_fit_descent(const CellTiles& cells, Descent& descent, const Loops& start,
                         int evaluations, bool again) {
  Fit fit;
  fit.loops = start;
  Minimum minimum;
  const StageTimer timer;
  minimum.evaluations = descent.run(cells, fit, evaluations);
  for (float before = 0.0F; again && fit.cost != before;) {
    before = fit.cost;
    minimum.evaluations += descent.run(cells, fit, evaluations);
  }
  minimum.seconds = timer.seconds();
  minimum.cost = static_cast<double>(fit.cost);
  return minimum;
}

/// Compares one minimiser with NLopt.
struct Against {
  Distribution difference, time;  // relative difference of the cost; [µs]
  double evaluations = 0;
  void add(const Minimum& ours, const Minimum& theirs) {
    difference.add((ours.cost - theirs.cost) / std::abs(theirs.cost));
    time.add(1e6 * ours.seconds);
    evaluations += ours.evaluations;
  }
  void print(const char* name) const {
    const Summary d = difference.summary(), t = time.summary();
    fmt::print("{:<34} {:>+9.2f} % {:>+9.2f} % {:>+9.2f} % {:>12.0f} {:>12.0f}\n", name,
               100.0 * d.mean, 100.0 * d.p50, 100.0 * d.max, t.p50,
               evaluations / static_cast<double>(d.n));
  }
};

void print_heading(const char* costs, const Against& theirs) {
  fmt::print(
      "\n{} from the same {} starts: (ours - NLopt's) / |NLopt's| of the final cost\n"
      "{:<34} {:>11} {:>11} {:>11} {:>12} {:>12}\n",
      costs, theirs.difference.count(), "", "mean", "median", "worst", "p50 us", "evaluations");
}

void append(const std::string& name, const Against& ours, const Against& theirs,
            std::vector<Row>& rows) {
  rows.push_back({name, "us", ours.time.summary(), "NLopt L-BFGS", theirs.time.summary().p50});
  rows.push_back({name + ", cost over NLopt's", "1", ours.difference.summary(), {}, 0.0});
}

/// The paper's costs: gradient descent of the paper's presets compared with NLopt.
void compare_refinement(int frames, std::vector<Row>& rows) {
  PlanSettings settings;
  settings.preset = Preset::Paper;
  Against preset, converged, theirs;
  for (const Sequence& sequence : gallery()) {
    Planner planner(settings, sequence.cells);
    PressureRaster raster(sequence.cells);
    for (const int frame : spread(sequence.frames, frames)) {
      const TargetField target = sequence.field(frame);
      const std::vector<Vec2> start = starting_paths(target, settings, planner);
      raster.set(target, max_pressure(target));
      const Minimum nlopt = with_nlopt(papers_cost(raster, settings), coordinates(start), 1e-10, 0);
      theirs.add(nlopt, nlopt);
      preset.add(with_descent(raster, settings, start, settings.refine_iterations), nlopt);
      converged.add(with_descent(raster, settings, start, 100'000), nlopt);
    }
  }
  print_heading("The paper's costs", theirs);
  preset.print("our descent, the preset's steps");
  converged.print("our descent, until it gains no more");
  theirs.print("NLopt, L-BFGS to convergence");
  append("planner/refinement, the preset's steps", preset, theirs, rows);
}

/// The costs of preset best: its L-BFGS compared with NLopt's.
void compare_fit(int frames, std::vector<Row>& rows) {
  PlanSettings settings;
  Against preset, converged, theirs;
  for (const Sequence& sequence : gallery()) {
    CellTiles cells(sequence.cells);
    InitialLoops initial(sequence.cells);
    Descent descent(CellTiles::kMaxTiles, settings.fit_samples, fit_settings(settings));
    for (const int frame : spread(sequence.frames, frames)) {
      const TargetField target = sequence.field(frame);
      cells.set(target, max_pressure(target), kFitWidth);
      initial.set(cells, static_cast<float>(settings.weak_pressure));
      Random random(static_cast<std::uint64_t>(frame));
      StartSettings start;
      start.paths = settings.paths;
      Loops loops;
      initial.make(start, settings.fit_samples, random, loops);
      std::vector<double> x;
      for_samples(loops, [&](int sample, int path) {
        const Vec2 p = loops.point(sample, path);
        x.insert(x.end(), {p.x(), p.y()});
      });
      const Minimum nlopt = with_nlopt(fit_cost(cells, descent, loops), x, 1e-7, 3);
      theirs.add(nlopt, nlopt);
      preset.add(with_fit_descent(cells, descent, loops, kFitEvaluations, false), nlopt);
      converged.add(with_fit_descent(cells, descent, loops, 2000, true), nlopt);
    }
  }
  print_heading("The costs of preset best", theirs);
  preset.print("our L-BFGS, as long as a start's");
  converged.print("our L-BFGS, until it gains no more");
  theirs.print("NLopt, L-BFGS to convergence");
  append("planner/fit, as long as a start's", preset, theirs, rows);
}

}  // namespace

void compare_with_nlopt(int frames, std::vector<Row>& rows) {
  compare_refinement(frames, rows);
  compare_fit(frames, rows);
}

}  // namespace prostm::bench

#else

namespace prostm::bench {

void compare_with_nlopt(int, std::vector<Row>&) {
  fmt::print("\nleft out: the comparison with NLopt (this build did not find libnlopt-dev)\n");
}

}  // namespace prostm::bench

#endif
