#pragma once
/// Maps of a patch of skin as an observer has them: blurred by the resolution of touch, at places.
/// (X8) of docs/design/psychophysics.md.

#include <span>
#include <vector>

#include "prostm/acoustics/skin/skin_motion.hpp"
#include "prostm/core/geometry.hpp"

namespace prostm {

/// Standard deviation of the Gaussian that models the skin's spatial resolution [m]: the
/// localisation error for AM focal points on the palm [Y-4].
inline constexpr double kTouchResolution = 8.5e-3;

/// Returns a map convolved with a Gaussian of standard deviation σ [m]; nothing comes from outside
/// the patch.
std::vector<double> blurred(const SkinPatch& patch, std::span<const double> map, double sigma);

/// Returns a map at places, a square grid about the patch's centre, by bilinear interpolation; 0
/// outside the patch. @param spacing of the places [m]. @param shift of the map [m].
std::vector<double> at_grid(const SkinPatch& patch, std::span<const double> map, double spacing,
                            const Vec2& shift = Vec2::Zero());

/// Returns a map's value at a place, by bilinear interpolation; 0 outside the patch.
double value_at(const SkinPatch& patch, std::span<const double> map, const Vec2& place);

/// Returns the centroid of a map, from the patch's centre [m]; 0 for a map of zeros.
Vec2 centroid(const SkinPatch& patch, std::span<const double> map);

}  // namespace prostm
