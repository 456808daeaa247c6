#include "planner/power.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "planner/as_played.hpp"
#include "planner/sequences.hpp"
#include "prostm/emit/detail/path_emitter.hpp"
#include "prostm/emit/drive.hpp"
#include "prostm/plan/lifted_plan.hpp"

namespace prostm::bench {
namespace {

constexpr int kInstants = 8;  // per lap of the longest path

double highest_pressure(const LiftedPlan& plan) {
  double highest = 0.0;
  for (const LiftedPath& path : plan.paths) {
    for (const double p : path.pressure) highest = std::max(highest, p);
  }
  return highest;
}

/// Returns the foci that the emitter would play `time` [s] after all paths began, ignoring slew
/// limits. @param wanted_power receives Σ I² before the limit.
std::vector<FocusSample> foci_at(const LiftedPlan& plan, double time, double full_scale,
                                 double& wanted_power) {
  const EmitSettings emit;
  std::vector<Drive> drives;
  std::vector<FocusSample> foci;
  wanted_power = 0.0;
  for (const LiftedPath& path : plan.paths) {
    const PathPoint point = point_at(path, time * path.speed);
    bool saturated = false;
    Drive drive;
    drive.max_fall = 1.0;
    drive.wanted = drive_intensity(point.pressure, full_scale, emit.silent_below, saturated);
    wanted_power += drive.wanted * drive.wanted;
    drives.push_back(drive);
    foci.push_back({point.p_D.cast<float>(), 0.0F});
  }
  limit_drives(drives, 1.0, emit.power_limit);
  for (std::size_t f = 0; f < foci.size(); ++f) {
    foci[f].intensity = static_cast<float>(drives[f].intensity);
  }
  return foci;
}

/// All plans with one number of paths.
struct AtPaths {
  Distribution rmse, coverage, skill;  // per plan
  Distribution wanted;                 // Σ I² at an instant
  double asked = 0.0, got = 0.0;       // Σ radiation pressure, relative to one focal point alone
  Distribution peak, mean;             // pressures reached in a plan
  Distribution full, superposed;       // at focal points that all want intensity 1

  void play(const TransducerArray& array, const LiftedPlan& plan, double period) {
    const double full_scale = highest_pressure(plan);
    double peak_of_plan = 0.0, sum = 0.0, count = 0.0;
    for (int i = 0; i < kInstants; ++i) {
      double power = 0.0;
      std::vector<FocusSample> foci =
          foci_at(plan, (i + 0.5) / kInstants * period, full_scale, power);
      wanted.add(power);
      asked += power;
      for (const double pressure : reached(array, FocusMethod::Weighted, foci)) {
        got += pressure;
        peak_of_plan = std::max(peak_of_plan, pressure);
        sum += pressure;
        count += 1.0;
      }
      for (FocusSample& focus : foci) focus.intensity = 1.0F;
      for (const double p : reached(array, FocusMethod::Weighted, foci)) full.add(p);
      for (const double p : reached(array, FocusMethod::Superposition, foci)) superposed.add(p);
    }
    peak.add(peak_of_plan);
    mean.add(sum / count);
  }
};

AtPaths plan_all(int paths, int frames, const TransducerArray& array) {
  AtPaths out;
  PlanSettings settings;
  settings.paths = paths;
  for (const Sequence& sequence : gallery()) {
    Planner planner(settings, sequence.cells);
    for (const int frame : spread(sequence.frames, frames)) {
      TargetFrame target;
      target.patches.push_back(sequence.field(frame));
      Plan plan;
      PlanStats stats;
      planner.reset();
      planner.plan(target.patches[0], plan, stats);
      const Metrics m = score_as_played(target.patches[0], plan, settings);
      out.rmse.add(m.rmse);
      out.coverage.add(m.coverage);
      out.skill.add(m.skill_8);
      LiftedPlan lifted;
      lift(plan, target, lifted);
      out.play(array, lifted, 1.0 / settings.draw_rate);
    }
  }
  return out;
}

}  // namespace

std::vector<double> reached(const TransducerArray& array, FocusMethod method,
                            const std::vector<FocusSample>& foci) {
  std::vector<Vec3> places;
  for (const FocusSample& focus : foci) places.push_back(focus.p_D.cast<double>());
  const Propagation g = propagation_to(array, Medium{}, places);
  const Eigen::VectorXd alone = g.cwiseAbs().rowwise().sum();
  Eigen::VectorXd target = alone;
  for (std::size_t f = 0; f < foci.size(); ++f) {
    target[static_cast<Eigen::Index>(f)] *= static_cast<double>(foci[f].intensity);
  }
  std::vector<double> out(foci.size(), 0.0);
  if (target.isZero(0.0)) return out;
  const FocusSolution solution = solve_foci(g, target, {.method = method});
  for (Eigen::Index f = 0; f < g.rows(); ++f) {
    const double share = std::abs(solution.pressure[f]) / alone[f];
    out[static_cast<std::size_t>(f)] = share * share;
  }
  return out;
}

void measure_power(int frames, std::vector<Row>& rows) {
  const TransducerArray array = usx_array();
  const double limit = EmitSettings{}.power_limit;
  fmt::print(
      "\nPaths and power, preset best, 200 mm above the array; pressures over that of one focal "
      "point at full drive\n{:>5} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>9} {:>9} {:>9} {:>9} "
      "{:>9}\n",
      "paths", "RMSE", "cover", "S_8.5", "asked", "p99", "E4a", "got", "highest", "mean", "full",
      "added");
  for (int paths = 1; paths <= kMaxPaths; ++paths) {
    const AtPaths at = plan_all(paths, frames, array);
    const Summary wanted = at.wanted.summary();
    fmt::print(
        "{:>5} {:>8.4f} {:>8.3f} {:>8.4f} {:>8.2f} {:>8.2f} {:>8.2f} {:>9.3f} {:>9.3f} {:>9.3f} "
        "{:>9.3f} {:>9.3f}\n",
        paths, at.rmse.summary().mean, at.coverage.summary().mean, at.skill.summary().mean,
        wanted.mean, wanted.p99, even_share(paths, limit), at.got / at.asked,
        at.peak.summary().mean, at.mean.summary().mean, at.full.summary().mean,
        at.superposed.summary().mean);
    const std::string name = fmt::format("planner/best/{} paths/", paths);
    rows.push_back({name + "rmse", "", at.rmse.summary(), "", 0.0});
    rows.push_back({name + "highest pressure reached", "", at.peak.summary(), "", 0.0});
  }
  fmt::print(
      "asked: sum of intensity^2 at a time, mean and p99; E4a: share of full scale that the limit "
      "of "
      "{:g} leaves each\ngot: rendered over asked; highest, mean: rendered pressures "
      "of a plan\nfull: all focal points at intensity 1; added: the same, superposed by (A11)\n",
      limit);
}

}  // namespace prostm::bench
