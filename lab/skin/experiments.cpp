/// Shared parts of the experiments, and the cost of a response of the skin.
#include "skin/experiments.hpp"

#include "prostm/core/random.hpp"
#include "prostm/core/stage_timer.hpp"
#include "skin/stimuli.hpp"

namespace prostm::bench {

Row value_row(const std::string& name, const std::string& unit, double value) {
  Distribution one;
  one.add(value);
  return {name, unit, one.summary(), "", 0.0};
}

double peak_place(const std::vector<double>& x, const std::vector<double>& y) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < y.size(); ++i) {
    if (y[i] > y[best]) best = i;
  }
  if (best == 0 || best + 1 == y.size()) return x[best];
  const double before = y[best - 1], at = y[best], after = y[best + 1];
  return x[best] + 0.5 * (x[best] - x[best - 1]) * (before - after) / (before - 2.0 * at + after);
}

void measure_response(std::vector<Row>& rows) {
  // 20 harmonics of 50 Hz on 64 × 64 cells, like a path of 140 mm at 7 m/s
  constexpr int kCells = 64, kSamples = 64;
  Random random(1);
  std::vector<double> pressure(kCells * kCells * kSamples);
  for (double& p : pressure) p = random.uniform();
  Distribution prepare, respond;
  SkinResponse response(SkinModel(SkinSettings()), {kCells, kCells, 2e-3});
  for (int i = 0; i < 20; ++i) {
    const StageTimer whole;
    response.prepare(0.02, kSamples);
    prepare.add(1e3 * whole.seconds());
    const StageTimer one;
    response.respond({0.02, kSamples, pressure});
    respond.add(1e3 * one.seconds());
  }
  rows.push_back({"skin, prepare 20 harmonics, 64 x 64", "ms", prepare.summary(), "", 0.0});
  rows.push_back({"skin, respond with 20 harmonics, 64 x 64", "ms", respond.summary(), "", 0.0});
}

}  // namespace prostm::bench
