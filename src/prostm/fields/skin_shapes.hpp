#pragma once
/// Generated uneven skins for the fields of fields.hpp.

#include <array>
#include <string>

#include "prostm/fields/fields.hpp"

namespace prostm::fields {

enum class SkinShape {
  CuppedPalm,  ///< a hollow towards the array: a sphere of 60 mm radius out to 50 mm from its axis
  Fist,        ///< four parallel half-cylinders of 9 mm radius side by side, towards the array
  CurledHand   ///< bent away: a cylinder of 25 mm radius up to slopes of 60°, then straight
};
inline constexpr std::array kSkinShapes{SkinShape::CuppedPalm, SkinShape::Fist,
                                        SkinShape::CurledHand};

/// Returns the name in tables: "cupped palm", "fist", "curled hand".
std::string to_string(SkinShape shape);

/// Edge of the voxels of with_skin() [m].
inline constexpr double kVoxel = 5.6e-3;

/// Returns the height of the exact surface above the plane, positive away from the array [m].
double skin_height(SkinShape shape, const Vec2& x);

/// Returns the field with the heights of a shape, rounded to whole voxels if `in_voxels`.
TargetField with_skin(TargetField field, SkinShape shape, bool in_voxels);

}  // namespace prostm::fields
