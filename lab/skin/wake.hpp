#pragma once
/// The skin under pressure that moves along a straight line for ever.

#include <span>
#include <vector>

#include "prostm/acoustics/skin_response.hpp"

namespace prostm {

/// Velocity of the skin [m/s] in a patch that moves along with the pressure on it, at `speed` along
/// +x, (S13): rows·cols. The skin goes on around the patch; copies of it are 0.6 m and more away.
/// @param pressure rows·cols [Pa]
/// @throws std::invalid_argument with a sentence: speed not in 0.01 to 100 m/s, cell not in 0.1 to
/// 20 mm, rows or cols not in 1 to 1024, not a pressure for each cell, or a skin without loss.
std::vector<double> wake_velocity(const SkinModel& model, const SkinPatch& patch,
                                  std::span<const double> pressure, double speed);

}  // namespace prostm
