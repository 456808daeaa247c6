#pragma once
/// Response of the skin to pressure that moves at constant speed along an infinite straight line.

#include <span>
#include <vector>

#include "prostm/acoustics/skin/skin_response.hpp"

namespace prostm {

/// Returns the velocity of the skin [m/s] in a patch that moves with its pressure at `speed` along
/// +x, (S13): rows·cols. The skin continues around the patch; copies of it are at least 0.6 m away.
/// @param pressure rows·cols [Pa]
/// @throws std::invalid_argument with a message: speed not in 0.01 to 100 m/s, cell not in 0.1 to
/// 20 mm, rows or cols not in 1 to 1024, not one pressure per cell, or a skin without loss.
std::vector<double> wake_velocity(const SkinModel& model, const SkinPatch& patch,
                                  std::span<const double> pressure, double speed);

}  // namespace prostm
