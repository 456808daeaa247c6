#include "prostm/plan/felt_plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "prostm/core/require.hpp"
#include "prostm/felt/felt_loss.hpp"
#include "prostm/felt/step_path.hpp"

namespace prostm {
namespace {

constexpr double kMm = 1e3;        // per metre
constexpr double kMostLaps = 1e6;  // maximum laps of a path in a loop
constexpr double kMicro = 1e6;     // µm per m

/// Returns the plan's largest pressure.
double check(const Plan& plan, const TargetField& target, std::span<const SkinSettings> skins) {
  if (plan.paths.empty()) throw std::invalid_argument("the plan has no path, so nothing is felt");
  if (!(plan.loop > 0.0)) {
    throw std::invalid_argument(
        "the plan is not in step: its paths have no common loop. Plan with preset felt");
  }
  if (skins.empty()) throw std::invalid_argument("skins is empty; give at least one skin");
  validate(target);
  if (!(max_pressure(target) > 0.0)) {
    throw std::invalid_argument("the target has no pressure, so there is nothing to render");
  }
  double largest = 0.0;
  for (const FocalPath& path : plan.paths) {
    if (path.patch != plan.paths[0].patch)
      throw std::invalid_argument("the plan has paths on two hands; it must have them on one");
    if (path.points.size() < 3 || !(closed_length(path) > 0.0)) {
      throw std::invalid_argument("a path of the plan has fewer than 3 points, or no length");
    }
    for (const double p : path.pressure) largest = std::max(largest, p);
  }
  if (!(largest > 0.0)) throw std::invalid_argument("the plan has no pressure anywhere");
  return largest;
}

/// The points of a plan as sources, one path after the other.
struct Sources {
  Sources(const Plan& plan, const Vec2& origin, double pressure_unit) : unit(pressure_unit) {
    const int first = first_felt_harmonic(plan.loop);
    for (const FocalPath& path : plan.paths) {
      std::array<double, kMaxPathPoints> x{}, y{};
      const std::size_t n = path.points.size();
      for (std::size_t i = 0; i < n; ++i) {
        x[i] = kMm * (path.points[i] - origin).x();
        y[i] = kMm * (path.points[i] - origin).y();
      }
      const double laps = std::clamp(std::round(plan.loop / path.period), 1.0, kMostLaps);
      paths.emplace_back().set(std::span(x).first(n), std::span(y).first(n),
                               static_cast<int>(laps));
      begin.push_back(source.size());
      source.resize(source.size() + n);
      paths.back().sources(first, std::span(source).last(n));
      for (const double p : path.pressure) pressure.push_back(p / unit);
    }
  }
  std::vector<StepPath<double>> paths;
  std::vector<std::size_t> begin;  // first source of each path
  std::vector<FeltSource<double>> source;
  std::vector<double> pressure;  // relative to the unit
  double unit;
};

FeltSkins<double> tables(std::span<const SkinSettings> skins, double sigma, double period) {
  FeltSkins<double> out(skins.size());
  FocusResponseMaker maker;
  for (std::size_t s = 0; s < skins.size(); ++s)
    maker.make(SkinModel(skins[s]), sigma, period, out[s]);
  return out;
}

/// Copies the gradient of the last evaluation of `loss`.
void take_gradient(const Plan& plan, const Sources& of, const std::vector<double>& by_pressure,
                   FeltLoss<double>& loss, FeltPlan& out) {
  const std::size_t all = of.source.size();
  std::vector<double> x(all), y(all), time(all), share(all);
  loss.slide(of.pressure, x, y);
  loss.turn(of.pressure, first_felt_harmonic(plan.loop), time);
  for (std::size_t k = 0; k < of.paths.size(); ++k) {
    const std::size_t first = of.begin[k], n = plan.paths[k].points.size();
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t j = first + i;
      time[j] /= of.paths[k].laps();
      share[j] = by_pressure[j] * of.pressure[j] / of.paths[k].share(i);
    }
    of.paths[k].add_gradient(std::span(time).subspan(first, n), std::span(share).subspan(first, n),
                             std::span(x).subspan(first, n), std::span(y).subspan(first, n));
    std::vector<double>& pressures = out.by_pressure.emplace_back();
    for (std::size_t j = first; j < first + n; ++j) pressures.push_back(by_pressure[j] / of.unit);
    std::vector<Vec2>& points = out.by_point.emplace_back();
    for (std::size_t j = first; j < first + n; ++j) points.push_back(kMm * Vec2(x[j], y[j]));
  }
}

}  // namespace

FeltPlan felt_plan(const Plan& plan, const TargetField& target, double sigma,
                   std::span<const SkinSettings> skins) {
  const double largest = check(plan, target, skins);
  require_between("sigma", sigma, 1e-3, 50e-3, "m");
  FeltCells cells(kFinerFeltCells);
  cells.set(target, max_pressure(target));
  const auto counts = [](const FeltCells::Cell& cell) { return cell.pressure > 0.0; };
  if (std::none_of(cells.cells().begin(), cells.cells().end(), counts))
    throw std::invalid_argument("the target has no pressure where its weights are above 0");
  const Sources of(plan, target.origin, largest);
  FeltLoss<double> loss(skins.size(), kFinerFeltCells, of.source.size(),
                        {.fine = 0.3, .energy = 0.0, .loudness = 0.0, .quiet = 0.0}, true);
  loss.set_target(cells);
  loss.set_sources(tables(skins, sigma, plan.loop), of.source);
  std::vector<double> by_pressure(of.source.size());
  FeltPlan out;
  out.lack = loss.evaluate(of.pressure);
  loss.gradient(by_pressure);
  for (const FeltCells::Cell& cell : cells.cells()) {
    out.blocks.push_back({target.origin + Vec2(cell.x, cell.y) / kMm, cell.area, cell.pressure});
  }
  for (std::size_t s = 0; s < skins.size(); ++s) {
    std::vector<double>& percept = out.percept.emplace_back();
    for (const double value : loss.percept(s)) percept.push_back(value * largest / kMicro);
  }
  take_gradient(plan, of, by_pressure, loss, out);
  return out;
}

}  // namespace prostm
