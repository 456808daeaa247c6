#include "prostm/psychophysics/percept_model.hpp"

#include <algorithm>
#include <cmath>

#include "prostm/acoustics/skin/skin_percept.hpp"
#include "prostm/core/random.hpp"
#include "prostm/psychophysics/places.hpp"

namespace prostm {
namespace {

using Amplitudes = std::vector<std::complex<double>>;

constexpr double kFieldSigma = 8.6e-3;      // σ of Eq. (1) [m]
constexpr double kCurvatureLength = 10e-3;  // makes a curvature a displacement [m]
constexpr double kRapidFrom = 40.0;         // the RA channel follows velocity up to here [Hz]

/// Sensitivity of the RA channel: velocity up to 40 Hz, displacement above; equal to (S6) at 40 Hz.
double rapid_sensitivity(double frequency) {
  return pacinian_sensitivity(kRapidFrom) * std::min(frequency, kRapidFrom) / kRapidFrom;
}

/// Returns L² times the Laplacian of each harmonic, by central differences; 0 on the border.
Amplitudes curvature(const Vibration& vibration) {
  const SkinPatch& patch = vibration.patch;
  const double scale = std::pow(kCurvatureLength / patch.cell, 2);
  Amplitudes out(vibration.displacement.size());
  const auto cols = static_cast<std::size_t>(patch.cols);
  for (int n = 0; n < vibration.harmonics; ++n) {
    const std::complex<double>* w =
        vibration.displacement.data() + static_cast<std::size_t>(n) * patch.size();
    std::complex<double>* to = out.data() + static_cast<std::size_t>(n) * patch.size();
    for (int j = 1; j + 1 < patch.rows; ++j) {
      for (int i = 1; i + 1 < patch.cols; ++i) {
        const auto c = static_cast<std::size_t>(j * patch.cols + i);
        to[c] = scale * (w[c - 1] + w[c + 1] + w[c - cols] + w[c + cols] - 4.0 * w[c]);
      }
    }
  }
  return out;
}

/// Weights each harmonic by a sensitivity.
Amplitudes weighted(Amplitudes amplitudes, const Vibration& vibration,
                    double (*sensitivity)(double)) {
  const std::size_t cells = vibration.patch.size();
  for (std::size_t i = 0; i < amplitudes.size(); ++i)
    amplitudes[i] *= sensitivity(vibration.frequency(static_cast<int>(i / cells) + 1));
  return amplitudes;
}

/// Adds ½|a|² of the harmonics whose frequency is within bounds to each cell.
void add_energy(const Amplitudes& amplitudes, const Vibration& vibration, double from, double to,
                std::vector<double>& out) {
  const std::size_t cells = vibration.patch.size();
  for (int n = 1; n <= vibration.harmonics; ++n) {
    if (vibration.frequency(n) < from || vibration.frequency(n) >= to) continue;
    const std::complex<double>* a = amplitudes.data() + static_cast<std::size_t>(n - 1) * cells;
    for (std::size_t c = 0; c < cells; ++c) out[c] += 0.5 * std::norm(a[c]);
  }
}

std::vector<double> squared(std::vector<double> values) {
  for (double& v : values) v *= v;
  return values;
}

/// Puts the cells in a fixed random order.
void shuffle_cells(std::vector<double>& map) {
  Random random(1);
  random.shuffle(map);
}

}  // namespace

void PerceptEnergy::add(const PerceptEnergy& other, double share) {
  fast.resize(other.fast.size());
  slow.resize(other.slow.size());
  for (std::size_t c = 0; c < fast.size(); ++c) {
    fast[c] += share * other.fast[c];
    slow[c] += share * other.slow[c];
  }
}

Amplitudes felt_amplitudes(PerceptModel model, const Vibration& vibration) {
  switch (model) {
    case PerceptModel::Curvature:
      return weighted(curvature(vibration), vibration, pacinian_sensitivity);
    case PerceptModel::NoSkin:
      return weighted(vibration.pressure, vibration, pacinian_sensitivity);
    case PerceptModel::Pressure:
      return vibration.pressure;
    case PerceptModel::MeanField:
    case PerceptModel::MeanPressure:
      return {};
    default:
      return weighted(vibration.displacement, vibration, pacinian_sensitivity);
  }
}

PerceptEnergy percept_energy(PerceptModel model, const Vibration& vibration) {
  const std::size_t cells = vibration.patch.size();
  PerceptEnergy out{std::vector<double>(cells), std::vector<double>(cells)};
  switch (model) {
    case PerceptModel::Pressure:
      out.fast = squared(vibration.largest);
      return out;
    case PerceptModel::MeanPressure:
      out.fast = squared(vibration.mean);
      return out;
    case PerceptModel::MeanField:
      out.fast = squared(blurred(vibration.patch, vibration.mean, kFieldSigma));
      return out;
    default:
      break;
  }
  const Amplitudes felt = felt_amplitudes(model, vibration);
  if (model == PerceptModel::TwoChannels) {
    add_energy(felt, vibration, 0.0, 1e9, out.fast);
    add_energy(weighted(curvature(vibration), vibration, rapid_sensitivity), vibration, 0.0, 1e9,
               out.slow);
    return out;
  }
  add_energy(felt, vibration, kAreaSumsFrom, 1e9, out.fast);
  add_energy(felt, vibration, 0.0, kAreaSumsFrom, out.slow);
  if (model == PerceptModel::Shuffled) {
    shuffle_cells(out.fast);
    shuffle_cells(out.slow);
  }
  return out;
}

std::vector<double> strength_map(PerceptModel model, const PerceptEnergy& energy) {
  std::vector<double> out(energy.fast.size());
  for (std::size_t c = 0; c < out.size(); ++c) {
    const auto [weaker, stronger] = std::minmax(energy.fast[c], energy.slow[c]);
    out[c] = model == PerceptModel::TwoChannels ? std::sqrt(stronger) + 0.5 * std::sqrt(weaker)
                                                : std::sqrt(energy.fast[c] + energy.slow[c]);
  }
  return out;
}

double strength_of(PerceptModel model, const SkinPatch& patch, const PerceptEnergy& energy) {
  const double share = patch.cell * patch.cell / kPerceptArea;
  if (model == PerceptModel::Area) {
    double summed = 0.0;
    for (const double e : energy.fast) summed += e;
    return std::sqrt(share * summed + std::ranges::max(energy.slow));
  }
  const std::vector<double> map = strength_map(model, energy);
  if (model != PerceptModel::Population) return std::ranges::max(map);
  double summed = 0.0;
  for (const double v : map) summed += std::pow(v, 4);
  return std::pow(share * summed, 0.25);
}

}  // namespace prostm
