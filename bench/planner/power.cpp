#include "planner/power.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "emit/drive.hpp"
#include "emit/path_emitter.hpp"
#include "plan/lifted_plan.hpp"
#include "planner/sequences.hpp"
#include "score/score.hpp"

namespace prostm::bench {
namespace {

constexpr int kInstants = 8;  // of a lap of the longest path

SimulatedArray make_array() {
  SimulatedArraySettings settings;
  settings.realtime = false;
  return SimulatedArray(settings, usx_array(), Medium{});
}

double highest_pressure(const LiftedPlan& plan) {
  double highest = 0.0;
  for (const LiftedPath& path : plan.paths) {
    for (const double p : path.pressure) highest = std::max(highest, p);
  }
  return highest;
}

/// What the emitter would play `time` [s] after all paths were begun, slew apart. @param
/// wanted_power gets Σ I² before the limit.
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
  Distribution rmse, coverage, skill;  // of plans
  Distribution wanted;                 // Σ I² of an instant
  double asked = 0.0, got = 0.0;       // Σ radiation pressure over one focal point alone
  Distribution peak, mean;             // of what a plan gets
  Distribution superposed, full;       // of focal points that all want intensity 1

  void play(const SimulatedArray& array, const LiftedPlan& plan, double period) {
    const double full_scale = highest_pressure(plan);
    double peak_of_plan = 0.0, sum = 0.0, count = 0.0;
    for (int i = 0; i < kInstants; ++i) {
      double power = 0.0;
      std::vector<FocusSample> foci =
          foci_at(plan, (i + 0.5) / kInstants * period, full_scale, power);
      wanted.add(power);
      asked += power;
      for (const double pressure : reached(array, foci).superposed) {
        got += pressure;
        peak_of_plan = std::max(peak_of_plan, pressure);
        sum += pressure;
        count += 1.0;
      }
      for (FocusSample& focus : foci) focus.intensity = 1.0F;
      const Reached equal = reached(array, foci);
      for (const double pressure : equal.superposed) superposed.add(pressure);
      for (const double pressure : equal.full) full.add(pressure);
    }
    peak.add(peak_of_plan);
    mean.add(sum / count);
  }
};

AtPaths plan_all(int paths, int frames, const SimulatedArray& array) {
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
      const Metrics m = score_plan(target.patches[0], plan, 0, settings.sigma, settings.gain_law());
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

Reached reached(const SimulatedArray& array, const std::vector<FocusSample>& foci) {
  std::vector<std::complex<double>> drives;
  std::vector<Vec3> places;
  for (const FocusSample& focus : foci) places.push_back(focus.p_D.cast<double>());
  const auto squared = [](double x) { return x * x; };

  std::vector<double> alone;  // at each place, with it alone at full drive
  for (std::size_t f = 0; f < foci.size(); ++f) {
    FocusSample one = foci[f];
    one.intensity = 1.0F;
    array.drives({&one, 1}, drives);
    alone.push_back(array.field(drives, {&places[f], 1})[0]);
  }
  Reached out;
  array.drives(foci, drives);
  const std::vector<double> together = array.field(drives, places);
  for (auto& drive : drives) {
    const double size = std::abs(drive);
    if (size > 0.0) drive /= size;
  }
  const std::vector<double> at_full = array.field(drives, places);
  for (std::size_t f = 0; f < foci.size(); ++f) {
    out.superposed.push_back(squared(together[f] / alone[f]));
    out.full.push_back(squared(at_full[f] / alone[f]));
  }
  return out;
}

void measure_power(int frames, std::vector<Row>& rows) {
  const SimulatedArray array = make_array();
  const double limit = EmitSettings{}.power_limit;
  fmt::print(
      "\nPaths and power, preset best, 200 mm above the array; pressures over that of one focal "
      "point at full drive\n{:>5} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>9} {:>9} {:>9} {:>9} "
      "{:>9}\n",
      "paths", "RMSE", "cover", "S_8.5", "asked", "p99", "E4a", "got", "highest", "mean", "(A4)",
      "full");
  for (int paths = 1; paths <= kMaxPaths; ++paths) {
    const AtPaths at = plan_all(paths, frames, array);
    const Summary wanted = at.wanted.summary();
    fmt::print(
        "{:>5} {:>8.4f} {:>8.3f} {:>8.4f} {:>8.2f} {:>8.2f} {:>8.2f} {:>9.3f} {:>9.3f} {:>9.3f} "
        "{:>9.3f} {:>9.3f}\n",
        paths, at.rmse.summary().mean, at.coverage.summary().mean, at.skill.summary().mean,
        wanted.mean, wanted.p99, even_share(paths, limit), at.got / at.asked,
        at.peak.summary().mean, at.mean.summary().mean, at.superposed.summary().mean,
        at.full.summary().mean);
    const std::string name = fmt::format("planner/best/{} paths/", paths);
    rows.push_back({name + "rmse", "", at.rmse.summary(), "", 0.0});
    rows.push_back({name + "highest pressure reached", "", at.peak.summary(), "", 0.0});
  }
  fmt::print(
      "asked: sum of intensity^2 at a time, mean and p99; E4a: share of full scale that the limit "
      "of "
      "{:g} leaves each\ngot: what the array renders of what is asked for; highest, mean: of that, "
      "of a plan\n(A4): all focal points at intensity 1, superposed; full: with every transducer "
      "at "
      "full drive\n",
      limit);
}

}  // namespace prostm::bench
