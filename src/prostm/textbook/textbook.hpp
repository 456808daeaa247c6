#pragma once
/// The baseline of every planner benchmark: a straightforward implementation of PRO-STM from the
/// paper, in double precision, with plain Lloyd from random points, plain 2-opt from a random tour,
/// midpoint splits, and steepest descent with backtracking. The costs, weights and decisions are
/// those of docs/design/planner.md, preset paper.

#include "prostm/plan/planner.hpp"
#include "prostm/textbook/kernel.hpp"

namespace prostm::textbook {

/// Plans one target like Planner::plan(), but allocates. The settings' preset is ignored:
/// violations are neither mended nor counted. @pre the target is valid (see validate()).
inline PlanStatus plan(const TargetField& target, const PlanSettings& settings, Plan& plan,
                       PlanStats& stats) {
  Settings s;
  s.paths = settings.paths;
  s.clusters = settings.clusters;
  s.samples = settings.samples;
  s.max_length = 1e3 * settings.max_length();
  s.sigma = 1e3 * settings.sigma;
  s.pressure = settings.weight_pressure;
  s.length = settings.weight_length;
  s.intersection = settings.weight_intersection;
  s.bending = settings.weight_bending;
  s.weak_pressure = settings.weak_pressure;
  s.lloyd_iterations = settings.lloyd_iterations;
  s.refine_iterations = settings.refine_iterations;
  s.seed = static_cast<std::uint64_t>(settings.seed);
  const Result result = run(
      {target.rows, target.cols, 1e3 * target.cell, target.pressure.data(), target.skin.data()}, s);

  stats = {};
  stats.init = result.init;
  stats.kmeans = result.kmeans;
  stats.tour = result.tour;
  stats.split = result.split;
  stats.resample = result.resample;
  stats.refine = result.refine;
  stats.total = result.total;
  stats.clusters = result.clusters;
  stats.leaves = result.leaves;
  stats.lloyd_iterations = result.lloyd_iterations;
  stats.refine_iterations = result.refine_iterations;
  stats.cost_evaluations = result.cost_evaluations;
  stats.cost = result.cost;

  plan.paths.clear();
  for (const Path& from : result.paths) {
    FocalPath path;
    for (std::size_t i = 0; i < from.x.size(); ++i) {
      path.points.push_back(target.origin + 1e-3 * Vec2(from.x[i], from.y[i]));
    }
    path.length = closed_length(path);
    path.speed = settings.speed;
    path.period = path.length / path.speed;
    const double gain = settings.gain_law().of(path.period);
    for (const double pressure : from.pressure) path.pressure.push_back(gain * pressure);
    plan.paths.push_back(path);
  }
  return plan.paths.empty() ? PlanStatus::EmptyTarget : PlanStatus::Planned;
}

}  // namespace prostm::textbook
