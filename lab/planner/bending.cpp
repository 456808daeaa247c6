#include "planner/bending.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "planner/as_played.hpp"
#include "planner/sequences.hpp"
#include "prostm/core/units.hpp"
#include "prostm/figure/figures.hpp"
#include "prostm/plan/planner.hpp"

namespace prostm::bench {
namespace {

constexpr std::array kWeights{0.0, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0};
constexpr int kFrames = 10;  // per field
constexpr double kDegrees = 180.0 / kPi;

/// A preset and its setting for the weight of bending.
struct Kind {
  const char* preset;
  const char* setting;
  double PlanSettings::*weight;
};
constexpr std::array kKinds{Kind{"best", "fit_bending", &PlanSettings::fit_bending},
                            Kind{"paper-valid", "weight_bending", &PlanSettings::weight_bending}};

/// The results of all plans with one weight.
struct AtWeight {
  double weight = 0.0;
  Distribution rmse, skill;  // per plan
  Distribution paths;
  Distribution sharpest, rms, excess, length;  // per path [degrees, mm]

  void add(const TargetField& field, const Plan& plan, const PlanSettings& s) {
    const Metrics m = score_as_played(field, plan, s);
    rmse.add(m.rmse);
    skill.add(m.skill_8);
    paths.add(static_cast<double>(plan.paths.size()));
    for (const FocalPath& path : plan.paths) {
      const Bending b = bending(path);
      sharpest.add(kDegrees * b.sharpest);
      rms.add(kDegrees * b.rms);
      excess.add(kDegrees * b.excess);
      length.add(1e3 * path.length);
    }
  }
};

AtWeight plan_all(const Kind& kind, double weight) {
  AtWeight out;
  out.weight = weight;
  PlanSettings settings;
  settings.preset = from_name<Preset>(kind.preset, "preset");
  settings.*kind.weight = weight;
  for (const Sequence& sequence : gallery()) {
    Planner planner(settings, sequence.cells);
    for (const int frame : spread(sequence.frames, kFrames)) {
      const TargetField field = sequence.field(frame);
      Plan plan;
      PlanStats stats;
      planner.reset();
      planner.plan(field, plan, stats);
      out.add(field, plan, settings);
    }
  }
  return out;
}

void print_table(const Kind& kind, const std::vector<AtWeight>& sweep) {
  fmt::print(
      "\nBending, preset {}: means over plans and over paths\n{:>14} {:>8} {:>8} {:>9} {:>10} "
      "{:>10} {:>14} {:>10}\n{:>14} {:>8} {:>8} {:>9} {:>10} {:>10} {:>14} {:>10}\n",
      kind.preset, kind.setting, "RMSE", "S_8.5", "sharpest", "of all", "root mean", "beyond 2 pi",
      "length", "", "", "", "deg", "p99 deg", "sq. deg", "deg", "mm");
  const double standard = PlanSettings{}.*kind.weight;
  for (const AtWeight& at : sweep) {
    fmt::print("{:>13g}{} {:>8.4f} {:>8.4f} {:>9.1f} {:>10.1f} {:>10.1f} {:>14.1f} {:>10.1f}\n",
               at.weight, at.weight == standard ? "*" : " ", at.rmse.summary().mean,
               at.skill.summary().mean, at.sharpest.summary().mean, at.sharpest.summary().p99,
               at.rms.summary().mean, at.excess.summary().mean, at.length.summary().mean);
  }
  fmt::print("{:>14} the default\n", "*");
}

/// Makes a line of the figure, starting with the roundest paths.
template <class X, class Y>
ChartSeries line(const Kind& kind, const std::vector<AtWeight>& sweep, const X& x, const Y& y) {
  ChartSeries series;
  series.name = kind.preset;
  for (auto at = sweep.rbegin(); at != sweep.rend(); ++at) {
    series.x.push_back(x(*at));
    series.y.push_back(y(*at));
    const bool standard = at->weight == PlanSettings{}.*kind.weight;
    series.labels.push_back(fmt::format("{:g}{}", at->weight, standard ? "*" : ""));
  }
  return series;
}

void draw(const std::array<std::vector<AtWeight>, kKinds.size()>& sweeps,
          const std::string& figure) {
  Chart error{"Error against corners, by the weight of bending (* default)",
              "sharpest corner of a path / degrees, mean",
              "RMSE over the target's maximum, mean",
              false,
              {},
              false};
  Chart skill{"Lack of skill against turning",
              "root mean square turn at a point of a path / degrees, mean",
              "1 − skill S₈.₅, mean",
              false,
              {},
              true};
  for (std::size_t k = 0; k < kKinds.size(); ++k) {
    error.series.push_back(line(
        kKinds[k], sweeps[k], [](const AtWeight& at) { return at.sharpest.summary().mean; },
        [](const AtWeight& at) { return at.rmse.summary().mean; }));
    skill.series.push_back(line(
        kKinds[k], sweeps[k], [](const AtWeight& at) { return at.rms.summary().mean; },
        [](const AtWeight& at) { return 1.0 - at.skill.summary().mean; }));
  }
  draw_charts({error, skill}, figure);
}

}  // namespace

Bending bending(const FocalPath& path) {
  Bending out;
  double sum = 0.0, squares = 0.0;
  const std::size_t n = path.points.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 a = path.points[(i + 1) % n] - path.points[i];
    const Vec2 b = path.points[(i + 2) % n] - path.points[(i + 1) % n];
    const double turn = std::abs(std::atan2(cross(a, b), a.dot(b)));
    out.sharpest = std::max(out.sharpest, turn);
    sum += turn;
    squares += turn * turn;
  }
  out.rms = std::sqrt(squares / static_cast<double>(n));
  out.excess = sum - 2.0 * kPi;
  return out;
}

void measure_bending(const std::string& figure, std::vector<Row>& rows) {
  std::array<std::vector<AtWeight>, kKinds.size()> sweeps;
  for (std::size_t k = 0; k < kKinds.size(); ++k) {
    for (const double weight : kWeights) sweeps[k].push_back(plan_all(kKinds[k], weight));
    print_table(kKinds[k], sweeps[k]);
    for (const AtWeight& at : sweeps[k]) {
      const std::string name =
          fmt::format("planner/{}/{} {:g}/", kKinds[k].preset, kKinds[k].setting, at.weight);
      rows.push_back({name + "rmse", "", at.rmse.summary(), "", 0.0});
      rows.push_back({name + "sharpest corner", "deg", at.sharpest.summary(), "", 0.0});
    }
  }
  if (!figure.empty()) draw(sweeps, figure);
}

}  // namespace prostm::bench
