#include "planner/nlopt_baseline.hpp"

#include <fmt/core.h>

#ifdef PROSTM_WITH_NLOPT

#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>

#include "core/stage_timer.hpp"
#include "plan/planner.hpp"
#include "plan/refine.hpp"
#include "plan/tours.hpp"
#include "planner/sequences.hpp"

namespace prostm::bench {
namespace {

using namespace planning;

/// Preset paper's paths before they are refined [mm from the raster's origin].
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

/// What NLopt is given: (P6) of coordinates x0, y0, x1, y1, …
struct Problem {
  Refiner refiner;
  const PressureRaster& raster;
  std::vector<Vec2> x, gradient;
  int evaluations = 0;
};

double cost(unsigned n, const double* x, double* gradient, void* data) {
  auto& problem = *static_cast<Problem*>(data);
  for (unsigned i = 0; i < n / 2; ++i) problem.x[i] = Vec2(x[2 * i], x[2 * i + 1]);
  const double value = problem.refiner.evaluate(problem.raster, problem.x, problem.gradient);
  for (unsigned i = 0; i < n / 2 && gradient != nullptr; ++i) {
    gradient[2 * i] = problem.gradient[i].x();
    gradient[2 * i + 1] = problem.gradient[i].y();
  }
  ++problem.evaluations;
  return value;
}

struct Minimum {
  double cost = 0.0, seconds = 0.0;
  int evaluations = 0;
};

Minimum with_nlopt(const PressureRaster& raster, const PlanSettings& settings,
                   const std::vector<Vec2>& start) {
  Problem problem{Refiner(CostSettings(settings), settings.paths, settings.samples, 0), raster,
                  start, start};
  std::vector<double> x;
  for (const Vec2& p : start) x.insert(x.end(), {p.x(), p.y()});
  const std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> opt(
      nlopt_create(NLOPT_LD_LBFGS, static_cast<unsigned>(x.size())), nlopt_destroy);
  nlopt_set_min_objective(opt.get(), cost, &problem);
  nlopt_set_vector_storage(opt.get(),
                           10);  // pairs that are kept; its own choice takes 15 times as long
  nlopt_set_ftol_rel(opt.get(), 1e-10);
  nlopt_set_maxeval(opt.get(), 50'000);
  Minimum minimum;
  const StageTimer timer;
  // a line search that can gain no more ends with a failure, at the best point all the same: the
  // costs have kinks
  nlopt_optimize(opt.get(), x.data(), &minimum.cost);
  minimum.seconds = timer.seconds();
  minimum.cost = cost(static_cast<unsigned>(x.size()), x.data(), nullptr, &problem);
  minimum.evaluations = problem.evaluations;
  return minimum;
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

/// Gathers one minimiser against NLopt.
struct Against {
  Distribution difference, time;  // of the cost, relative; [µs]
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

}  // namespace

void compare_with_nlopt(int frames, std::vector<Row>& rows) {
  PlanSettings settings;
  settings.preset = "paper";
  Against preset, converged, theirs;
  for (const Sequence& sequence : gallery()) {
    Planner planner(settings, sequence.cells);
    PressureRaster raster(sequence.cells);
    for (const int frame : spread(sequence.frames, frames)) {
      const TargetField target = sequence.field(frame);
      const std::vector<Vec2> start = starting_paths(target, settings, planner);
      raster.set(target, max_pressure(target));
      const Minimum nlopt = with_nlopt(raster, settings, start);
      theirs.add(nlopt, nlopt);
      preset.add(with_descent(raster, settings, start, settings.refine_iterations), nlopt);
      converged.add(with_descent(raster, settings, start, 100'000), nlopt);
    }
  }
  fmt::print(
      "\nThe paper's costs from the same {} starts: (ours - NLopt's) / |NLopt's| of the "
      "final cost\n{:<34} {:>11} {:>11} {:>11} {:>12} {:>12}\n",
      theirs.difference.count(), "", "mean", "median", "worst", "p50 us", "evaluations");
  preset.print("our descent, the preset's steps");
  converged.print("our descent, until it gains no more");
  theirs.print("NLopt, L-BFGS to convergence");
  rows.push_back({"planner/refinement, the preset's steps", "us", preset.time.summary(),
                  "NLopt L-BFGS", theirs.time.summary().p50});
  rows.push_back(
      {"planner/refinement, cost over NLopt's", "1", preset.difference.summary(), {}, 0.0});
}

}  // namespace prostm::bench

#else

namespace prostm::bench {

void compare_with_nlopt(int, std::vector<Row>&) {
  fmt::print("\nleft out: the comparison with NLopt (this build did not find libnlopt-dev)\n");
}

}  // namespace prostm::bench

#endif
