#include "prostm/psychophysics/felt_stimulus.hpp"

#include <algorithm>
#include <boost/math/statistics/linear_regression.hpp>
#include <cmath>

#include "prostm/core/units.hpp"
#include "prostm/psychophysics/places.hpp"

namespace prostm {
namespace {

/// The energies of a stimulus, moment by moment.
struct Moments {
  std::vector<PerceptEnergy> energy;
  std::vector<double> duration;
};

/// Returns the largest strength of the energy within kPerceptTime, (X9). The stimulus repeats.
double strongest(PerceptModel model, const SkinPatch& patch, const Moments& moments) {
  double out = 0.0;
  for (std::size_t first = 0; first < moments.energy.size(); ++first) {
    PerceptEnergy window;
    double left = kPerceptTime;
    if (moments.energy.size() == 1) return strength_of(model, patch, moments.energy.front());
    for (std::size_t i = first; left > 1e-9; i = (i + 1) % moments.energy.size()) {
      const double time = std::min(left, moments.duration[i]);
      window.add(moments.energy[i], time / kPerceptTime);
      left -= time;
    }
    out = std::max(out, strength_of(model, patch, window));
  }
  return out;
}

/// Returns the slope of the arrival time over x, times the length of the patch that the sweep
/// covers. The arrival at a cell is the mean time of its vibration, weighted by its energy.
double delay_of(const Vibration& vibration, const std::vector<std::complex<double>>& amplitudes,
                double length) {
  if (amplitudes.empty()) return 0.0;
  const SkinPatch& patch = vibration.patch;
  const int times = 2 * vibration.harmonics + 2, row = patch.rows / 2;
  const int half = static_cast<int>(0.5 * length / patch.cell);
  std::vector<std::complex<double>> turns;
  for (int k = 0; k < times; ++k) turns.push_back(std::polar(1.0, 2.0 * kPi * k / times));
  std::vector<double> place, arrival;
  for (int i = std::max(0, patch.cols / 2 - half); i < std::min(patch.cols, patch.cols / 2 + half);
       ++i) {
    double energy = 0.0, moment = 0.0;
    for (int k = 0; k < times; ++k) {
      double w = 0.0;
      for (int n = 1; n <= vibration.harmonics; ++n) {
        const auto at = static_cast<std::size_t>(n - 1) * patch.size() +
                        static_cast<std::size_t>(row * patch.cols + i);
        w += (amplitudes[at] * turns[static_cast<std::size_t>(n * k % times)]).real();
      }
      energy += w * w;
      moment += w * w * vibration.period * k / times;
    }
    if (energy <= 0.0) continue;
    place.push_back(patch.cell * i);
    arrival.push_back(moment / energy);
  }
  if (place.size() < 2) return 0.0;
  return length * boost::math::statistics::simple_ordinary_least_squares(place, arrival).second;
}

FeltStimulus felt_from(PerceptModel model, const SkinPatch& patch, const Moments& moments) {
  FeltStimulus out;
  out.patch = patch;
  std::vector<double> mean(patch.size());
  double all = 0.0;
  for (const double duration : moments.duration) all += duration;
  for (std::size_t i = 0; i < moments.energy.size(); ++i) {
    const std::vector<double> map = strength_map(model, moments.energy[i]);
    for (std::size_t c = 0; c < map.size(); ++c) mean[c] += moments.duration[i] / all * map[c];
    std::vector<double> energy = map;
    for (double& v : energy) v *= v;
    out.course.push_back({moments.duration[i], centroid(patch, energy)});
  }
  out.map = blurred(patch, mean, kTouchResolution);
  out.strength = strongest(model, patch, moments);
  return out;
}

FeltStimulus nothing_felt() {
  FeltStimulus out;
  out.map.assign(out.patch.size(), 0.0);
  return out;
}

}  // namespace

std::vector<double> FeltStimulus::places(const Vec2& shift) const {
  return at_grid(patch, map, kTouchResolution, shift);
}

Feeler::Feeler(const SkinSettings& skin, const TransducerArray& array, std::function<void()> step)
    : presenter_(skin, array), step_(std::move(step)) {}

const FeltByModel& Feeler::feel(const std::string& key, const PresentedStimulus& stimulus,
                                double height) {
  const auto known = felt_.find(key);
  if (known != felt_.end()) return known->second;
  std::array<Moments, kPerceptModels> moments;
  std::array<double, kPerceptModels> delay{};
  SkinPatch patch;
  presenter_.present(stimulus, height, [&](const Vibration& vibration, double duration) {
    patch = vibration.patch;
    for (std::size_t m = 0; m < kPerceptModels; ++m) {
      const auto model = static_cast<PerceptModel>(m);
      moments[m].energy.push_back(percept_energy(model, vibration));
      moments[m].duration.push_back(duration);
      if (const auto* sweep = std::get_if<Sweep>(&stimulus))
        delay[m] = delay_of(vibration, felt_amplitudes(model, vibration), sweep->length);
    }
    step_();
  });
  FeltByModel out;
  for (std::size_t m = 0; m < kPerceptModels; ++m) {
    out[m] = moments[m].energy.empty() ? nothing_felt()
                                       : felt_from(static_cast<PerceptModel>(m), patch, moments[m]);
    out[m].delay = delay[m];
  }
  return felt_.emplace(key, std::move(out)).first->second;
}

}  // namespace prostm
