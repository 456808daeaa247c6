#include "planner/weights.hpp"

#include <fmt/core.h>

#include <cmath>

#include "prostm/fields/fields.hpp"
#include "prostm/plan/planner.hpp"
#include "prostm/plan/quasi_static/quasi_static.hpp"

namespace prostm::bench {
namespace {

constexpr double kWeight = 4.0;

/// Mean squared errors over the skin in the lower and the upper half of the rows, relative to max
/// p*.
struct Halves {
  double lower = 0.0, upper = 0.0;
};

Halves errors_of(const TargetField& field, Planner& planner) {
  const PlanSettings& s = planner.settings();
  Plan plan;
  PlanStats stats;
  planner.reset();
  planner.plan(field, plan, stats);
  std::vector<double> rendered(field.size());
  quasi_static_field(plan, 0, field, s.sigma, s.gain_law(), rendered);
  const double maximum = max_pressure(field);
  const std::size_t middle = field.index(field.rows / 2, 0);
  double sum[2] = {}, cells[2] = {};
  for (std::size_t i = 0; i < field.size(); ++i) {
    if (field.skin[i] == 0) continue;
    const double error = (rendered[i] - field.pressure[i]) / maximum;
    sum[i < middle ? 0 : 1] += error * error;
    cells[i < middle ? 0 : 1] += 1.0;
  }
  return {sum[0] / cells[0], sum[1] / cells[1]};
}

/// RMSE over all frames of one field, or sums over fields.
struct Line {
  Halves without, with;

  void add(const Line& other) {
    without.lower += other.without.lower;
    without.upper += other.without.upper;
    with.lower += other.with.lower;
    with.upper += other.with.upper;
  }
  void print(const std::string& name) const {
    fmt::print("{:<24} {:>8.4f} {:>8.4f} {:>+8.1f} {:>9.4f} {:>8.4f} {:>+8.1f}\n", name,
               without.upper, with.upper, 100.0 * (with.upper / without.upper - 1.0), without.lower,
               with.lower, 100.0 * (with.lower / without.lower - 1.0));
  }
};

Line measure_pattern(fields::Pattern pattern, int frames, Planner& planner) {
  Line mean;
  for (int i = 0; i < frames; ++i) {
    TargetField field = fields::make(pattern, i * fields::kFrames / frames);
    Line one;
    one.without = errors_of(field, planner);
    field.weight.assign(field.size(), 1.0);
    for (std::size_t c = field.index(field.rows / 2, 0); c < field.size(); ++c) {
      field.weight[c] = kWeight;
    }
    one.with = errors_of(field, planner);
    mean.add(one);
  }
  for (double* e : {&mean.without.lower, &mean.without.upper, &mean.with.lower, &mean.with.upper}) {
    *e = std::sqrt(*e / frames);
  }
  return mean;
}

}  // namespace

void measure_weights(int frames, std::vector<Row>& rows) {
  fmt::print(
      "\nUpper half weighed {:g} times, RMSE of best over {} frames each\n{:<24} {:>8} {:>8} {:>8} "
      "{:>9} {:>8} {:>8}\n{:<24} {:>8} {:>8} {:>8} {:>9} {:>8} {:>8}\n",
      kWeight, frames, "", "upper", "weighed", "change", "lower", "weighed", "change", "", "", "",
      "%", "", "", "%");
  Planner planner(PlanSettings{}, static_cast<std::size_t>(fields::kCells) * fields::kCells);
  Distribution upper, lower;  // changes [%]
  Line sum;
  for (const fields::Pattern pattern : fields::kPatterns) {
    const Line line = measure_pattern(pattern, frames, planner);
    line.print(to_string(pattern));
    sum.add(line);
    upper.add(100.0 * (line.with.upper / line.without.upper - 1.0));
    lower.add(100.0 * (line.with.lower / line.without.lower - 1.0));
  }
  sum.print("sum");
  rows.push_back({"planner/best/RMSE, half weighed 4 times", "%", upper.summary(), "", 0.0});
  rows.push_back({"planner/best/RMSE, the other half", "%", lower.summary(), "", 0.0});
}

}  // namespace prostm::bench
