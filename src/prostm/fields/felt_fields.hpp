#pragma once
/// Generated target fields for evaluating the percept of plans: flat skin 200 mm above the array,
/// of two outlines, with pressure patterns of 21 kinds. The seed determines a pattern's
/// position, rotation and size.
///
/// All fields depend on their arguments alone. Rasters are centred on the origin; the largest
/// pressure is 1.

#include <array>
#include <cstdint>
#include <string>

#include "prostm/target/target_field.hpp"

namespace prostm::fields {

/// Outline and raster of the skin.
enum class Outline {
  Hand,  ///< an open hand of 105 mm × 180 mm, cells of 5 mm
  Palm   ///< an oval of 76 mm × 96 mm, cells of 4 mm
};

/// The kind of a pattern. Those of kUnseenKinds and kDrawnKinds are reserved for evaluation:
/// nothing may be tuned on them.
enum class FeltKind {
  Plume,
  TwoPlumes,
  ThreePlumes,
  FourPlumes,
  Circle,
  Cross,
  Gradient,
  Stripe,
  Front,     ///< a half-plane
  Strokes,   ///< T, H, V or Z
  BlobPair,  ///< a strong blob and a weak, wider one
  Speckle,
  // unseen
  Spiral,
  Crescent,
  Checkerboard,
  Zigzag,
  Triangle,  ///< its outline
  Moat,      ///< a disc with a trench around its middle
  Steps,     ///< three plateaus side by side
  Comb,      ///< three bars of different strength
  // unseen, and of no designed shape
  Drawn  ///< the strongest of one to four random blobs, bars and arcs at each point
};
inline constexpr std::array kFeltKinds{
    FeltKind::Plume,  FeltKind::TwoPlumes, FeltKind::ThreePlumes, FeltKind::FourPlumes,
    FeltKind::Circle, FeltKind::Cross,     FeltKind::Gradient,    FeltKind::Stripe,
    FeltKind::Front,  FeltKind::Strokes,   FeltKind::BlobPair,    FeltKind::Speckle};
inline constexpr std::array kUnseenKinds{
    FeltKind::Spiral,   FeltKind::Crescent, FeltKind::Checkerboard, FeltKind::Zigzag,
    FeltKind::Triangle, FeltKind::Moat,     FeltKind::Steps,        FeltKind::Comb};
inline constexpr std::array kDrawnKinds{FeltKind::Drawn};

/// Returns the name in tables: "plume", "two plumes", …
std::string to_string(FeltKind kind);
/// Returns "hand" or "palm".
std::string to_string(Outline outline);

/// Makes the field of a kind and a seed.
TargetField felt_field(FeltKind kind, std::uint64_t seed, Outline outline);

}  // namespace prostm::fields
