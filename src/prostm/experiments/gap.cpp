/// The gap above which two foci, amplitude modulated at 200 Hz, are perceived as two.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prostm/acoustics/skin/skin_percept.hpp"
#include "prostm/core/units.hpp"
#include "prostm/experiments/experiments.hpp"
#include "prostm/experiments/stimuli.hpp"
#include "prostm/figure/figures.hpp"

namespace prostm::experiments {
namespace {

constexpr int kSamples = 16;  // per period of the modulation
const SkinPatch kPatch{49, 65, 1.5e-3};

/// Returns the value midway over the higher peak, along the line of two foci; 1: a single peak.
double dip(const std::vector<double>& map) {
  const auto row = static_cast<std::size_t>(kPatch.rows / 2 * kPatch.cols);
  const auto first = map.begin() + static_cast<std::ptrdiff_t>(row);
  return first[kPatch.cols / 2] / *std::max_element(first, first + kPatch.cols);
}

/// Returns the pressure at rest times the square of (1 + cos ωt)/2, the drive of each transducer.
std::vector<double> modulated(const std::vector<double>& at_rest) {
  std::vector<double> pressure;
  for (int k = 0; k < kSamples; ++k) {
    const double drive = 0.5 + 0.5 * std::cos(2.0 * kPi * k / kSamples);
    for (const double p : at_rest) pressure.push_back(drive * drive * p);
  }
  return pressure;
}

}  // namespace

GapCurves gap_curves(Skins skins, const Step& step) {
  const TransducerArray array = usx_array();
  const Palm palm{kPatch};
  std::vector<SkinResponse> responses;
  for (const SkinSettings& settings : skins) {
    responses.emplace_back(SkinModel(settings), kPatch);
    responses.back().prepare(1.0 / kGapRate, kSamples);
  }
  GapCurves out;
  out.skins.assign(skins.begin(), skins.end());
  out.felt.resize(skins.size());
  for (double gap = 6e-3; gap < 60.5e-3; gap += 1.5e-3) {
    const std::vector<double> at_rest =
        foci_pressure(array, palm, {Vec2(-0.5 * gap, 0.0), Vec2(0.5 * gap, 0.0)});
    const std::vector<double> pressure = modulated(at_rest);
    out.gaps.push_back(gap);
    out.acoustic.push_back(dip(at_rest));
    std::vector<double> map(palm.cells());
    for (std::size_t s = 0; s < skins.size(); ++s) {
      responses[s].respond({1.0 / kGapRate, kSamples, pressure});
      percept_map(responses[s], map);
      out.felt[s].push_back(dip(map));
    }
    step();
  }
  return out;
}

double gap_where(const std::vector<double>& gaps, const std::vector<double>& dips, double level) {
  for (std::size_t i = gaps.size(); i-- > 0;) {
    if (dips[i] <= level) continue;
    if (i + 1 == gaps.size()) return 0.0;
    const double share = (dips[i] - level) / (dips[i] - dips[i + 1]);
    return gaps[i] + share * (gaps[i + 1] - gaps[i]);
  }
  return gaps.front();
}

void draw_gap(const GapCurves& curves, const std::string& path) {
  Chart chart{"Two foci, modulated at 200 Hz",
              "gap / mm",
              "midpoint over the higher peak",
              false,
              {},
              false};
  const auto add = [&](const std::string& name, const std::vector<double>& dips) {
    ChartSeries series{name, {}, dips};
    for (const double gap : curves.gaps) series.x.push_back(1e3 * gap);
    chart.series.push_back(series);
  };
  add("pressure", curves.acoustic);
  const std::size_t nominal = curves.skins.size() / 2;
  for (std::size_t s = 0; s < curves.skins.size(); ++s) {
    if (curves.skins[s].loss != curves.skins[nominal].loss) continue;
    add(fmt::format("felt, waves of {:.0f} m/s", curves.skins[s].fast_speed), curves.felt[s]);
  }
  draw_charts({chart}, path);
}

}  // namespace prostm::experiments
