#pragma once
/// Skins that move under a loop of pressure, and maps of their motion.

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "prostm/acoustics/skin/skin_motion.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm::bench {

/// Returns the motion of a whole raster under a loop of pressure, valid until the next call.
using FeelLoop = std::function<const SkinMotion&(const PressureLoop&)>;

/// A skin that can be placed under any raster: its cells and its mask. A FeelLoop reuses its
/// results for a period, and serves one thread.
struct Skin {
  std::string name;
  std::function<FeelLoop(const TargetField& raster)> under;
};

/// Returns the nominal skin first, then those with both wave speeds times 0.7 and 1.3, with a
/// plateau of 5 and 10 m/s, with a loss of 0.07 and 0.21, all half-spaces, and last the nominal
/// skin that ends where that of the raster does.
std::vector<Skin> skins();

/// Readouts of a motion, each a map over the raster's skin and 0 elsewhere.
enum class Readout {
  Intensity,    ///< √e of (S7)
  Energy,       ///< e of (S7)
  Velocity,     ///< rms, (S10)
  Peak,         ///< largest displacement of the loop, of either sign
  Displacement  ///< rms
};
inline constexpr std::array kReadouts = {Readout::Intensity, Readout::Energy, Readout::Velocity,
                                         Readout::Peak, Readout::Displacement};
std::vector<double> map_of(Readout readout, const SkinMotion& motion, const TargetField& raster);

}  // namespace prostm::bench
