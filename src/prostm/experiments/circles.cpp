/// Perceived intensity of circles against speed.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prostm/acoustics/skin/skin_percept.hpp"
#include "prostm/experiments/experiments.hpp"
#include "prostm/experiments/stimuli.hpp"
#include "prostm/figure/figures.hpp"

namespace prostm::experiments {
namespace {

constexpr int kFastest = 15;  // [m/s]

/// 1, 2, … kFastest [m/s]
std::vector<double> circle_speeds() {
  std::vector<double> all;
  for (int v = 1; v <= kFastest; ++v) all.push_back(v);
  return all;
}

double largest_rms_displacement(const SkinResponse& response, std::size_t cells) {
  double most = 0.0;
  for (std::size_t c = 0; c < cells; ++c) {
    double sum = 0.0;
    for (int n = 1; n <= response.harmonics(); ++n) {
      sum += 0.5 * std::norm(response.displacement(n)[c]);
    }
    most = std::max(most, sum);
  }
  return std::sqrt(most);
}

void append(SkinResponse& response, const Palm& palm, const PressureLoop& loop, Curve& curve) {
  response.prepare(loop.period, loop.samples);
  response.respond(loop);
  std::vector<double> map(palm.cells());
  rms_velocity(response, map);
  curve.intensity.push_back(perceived_intensity(response));
  curve.displacement.push_back(largest_rms_displacement(response, palm.cells()));
  curve.velocity.push_back(*std::max_element(map.begin(), map.end()));
}

CircleCurves compute(double circumference, const StmField& field, const Palm& palm,
                     std::vector<SkinResponse>& responses, const Step& step) {
  CircleCurves curves{circumference, circle_speeds(), std::vector<Curve>(responses.size()), {}};
  const Lap lap = circle_lap(circumference);
  for (const double speed : curves.speeds) {
    const double period = circumference / speed;
    const std::vector<double> real = field.pressure(lap, period, false);
    for (std::size_t s = 0; s < responses.size(); ++s) {
      append(responses[s], palm, {period, StmField::kSamples, real}, curves.skins[s]);
    }
    const std::vector<double> ideal = field.pressure(lap, period, true);
    append(responses[responses.size() / 2], palm, {period, StmField::kSamples, ideal},
           curves.memoryless);
    step();
  }
  return curves;
}

Chart chart_of(const std::string& title, const std::vector<CircleCurves>& all, bool memoryless) {
  Chart chart{title,
              "speed of the focal point / (m/s)",
              "equivalent displacement at 250 Hz / µm rms",
              false,
              {},
              false};
  for (const CircleCurves& of : all) {
    const Curve& curve = memoryless ? of.memoryless : of.nominal();
    ChartSeries series{fmt::format("{:.0f} mm", 1e3 * of.circumference), of.speeds, {}};
    for (const double value : curve.intensity) series.y.push_back(1e6 * value);
    chart.series.push_back(series);
  }
  return chart;
}

}  // namespace

std::vector<CircleCurves> circle_curves(std::span<const double> circumferences, Skins skins,
                                        const Step& step) {
  const Palm palm;
  const StmField field(usx_array(), palm);
  std::vector<SkinResponse> responses;
  for (const SkinSettings& settings : skins)
    responses.emplace_back(SkinModel(settings), palm.patch);
  std::vector<CircleCurves> all;
  for (const double circumference : circumferences)
    all.push_back(compute(circumference, field, palm, responses, step));
  return all;
}

void draw_circles(const std::vector<CircleCurves>& all, const std::string& path) {
  draw_charts({chart_of("Transducers with a time constant of 0.23 ms", all, false),
               chart_of("Transducers without delay", all, true)},
              path);
}

}  // namespace prostm::experiments
