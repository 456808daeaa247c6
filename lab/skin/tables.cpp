#include "skin/tables.hpp"

#include "prostm/acoustics/skin/skin_response.hpp"
#include "prostm/core/random.hpp"
#include "prostm/core/stage_timer.hpp"

namespace prostm::bench {

Row value_row(const std::string& name, const std::string& unit, double value) {
  Distribution one;
  one.add(value);
  return {name, unit, one.summary(), "", 0.0};
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
