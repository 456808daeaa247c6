#pragma once
/// Models of how strongly a vibration of the skin is felt, and controls that are not models of
/// perception: (X6) and (X7) of docs/design/psychophysics.md.

#include <array>
#include <complex>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "prostm/core/text/names.hpp"
#include "prostm/psychophysics/presenter.hpp"

namespace prostm {

enum class PerceptModel : std::uint8_t {
  Peak,          ///< √e of (S7) at its maximum
  Area,          ///< √E of (S8): energy summed over area
  Population,    ///< as Area, with the fourth power of √e: between Peak and Area
  TwoChannels,   ///< the stronger of the Pacinian and the RA channel, and half of the weaker
  Curvature,     ///< as Peak, of the surface's curvature instead of its displacement
  Pressure,      ///< control: the largest radiation pressure
  MeanField,     ///< control: the mean radiation pressure as Eq. (1) blurs it
  MeanPressure,  ///< control: the mean radiation pressure
  Shuffled,      ///< control: Peak, with the places of the map in random order
  NoSkin,        ///< control: radiation pressure weighted by (S6), without waves in the skin
};
template <>
inline constexpr std::array<std::string_view, 10> kNames<PerceptModel> = {
    "peak",     "area",       "population",    "two-channels", "curvature",
    "pressure", "mean-field", "mean-pressure", "shuffled",     "no-skin"};
inline constexpr std::size_t kPerceptModels = kNames<PerceptModel>.size();
/// Whether it is a control.
constexpr bool is_control(PerceptModel model) {
  return model >= PerceptModel::Pressure;
}

/// The energy of a percept in each cell, the mean over time. The unit is the square of the model's
/// unit of strength: m, or Pa for controls.
struct PerceptEnergy {
  std::vector<double> fast;  ///< of the channel that sums over area
  std::vector<double> slow;  ///< of the other

  /// Adds `share` times another energy.
  void add(const PerceptEnergy& other, double share);
};

/// Returns the energy of a vibration, (X6).
PerceptEnergy percept_energy(PerceptModel model, const Vibration& vibration);
/// Returns the map of the percept's strength, rows·cols.
std::vector<double> strength_map(PerceptModel model, const PerceptEnergy& energy);
/// Returns the strength of the whole percept, (X7).
double strength_of(PerceptModel model, const SkinPatch& patch, const PerceptEnergy& energy);
/// Returns the complex amplitude of each harmonic in each cell whose course in time is felt; empty
/// for the models without time.
std::vector<std::complex<double>> felt_amplitudes(PerceptModel model, const Vibration& vibration);

}  // namespace prostm
