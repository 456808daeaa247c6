#pragma once
/// Generated target fields for benchmarks and tests: nine pressure patterns on a hand-shaped skin,
/// each a sequence at 25 updates a second with smooth changes of position, shape and strength.
///
/// All fields depend on their arguments alone: the same pattern and frame give the same field.
/// Rasters are centred on the origin; pressures are of order 1.

#include <array>
#include <string>
#include <vector>

#include "prostm/target/target_field.hpp"

namespace prostm::fields {

inline constexpr int kCells = 80;           ///< rows and columns
inline constexpr double kCell = 2e-3;       ///< edge of a cell [m]
inline constexpr int kFrames = 100;         ///< per sequence; later frames continue smoothly
inline constexpr double kFrameTime = 0.04;  ///< between frames [s]

enum class Pattern {
  OnePlume,
  FourPlumes,
  Ring,
  Ridge,
  Letter,
  Noise,
  Fingertips,  ///< contacts on two fingertips
  Palm,        ///< the whole palm, pressed flat
  Edge         ///< a front that sweeps over the hand, with pressure falling off behind it
};
inline constexpr std::array kPatterns{Pattern::OnePlume,   Pattern::FourPlumes, Pattern::Ring,
                                      Pattern::Ridge,      Pattern::Letter,     Pattern::Noise,
                                      Pattern::Fingertips, Pattern::Palm,       Pattern::Edge};

/// Returns the name in tables: "one-plume", …, "two-fingertips", "palm", "moving-edge".
std::string to_string(Pattern pattern);

/// Makes one frame of a pattern's sequence on the open hand, `cells`² cells on 160 mm × 160 mm.
/// From frame to frame a pattern moves by at most 4 mm. @pre frame >= 0, cells >= 8.
TargetField make(Pattern pattern, int frame, int cells = kCells);

/// Rows and columns of the fields of moved(): 200 mm, so that the pattern stays within the raster.
inline constexpr int kMovedCells = 100;
/// Displacement of the pattern of moved() from its position in frame 0 [m]. It moves on a circle of
/// radius 12 mm in 50 frames, by kMovedStep per frame.
Vec2 displacement(int frame);
inline constexpr double kMovedStep = 1.507e-3;  ///< [m]: 24 mm · sin(π/50)
/// Makes the pattern, cut off smoothly at 85 mm from its centre and moved rigidly by
/// displacement(frame), on a raster of kMovedCells² cells that are all skin.
TargetField moved(Pattern pattern, int frame);

/// A steady contact, and a second one that appears.
struct Appearing {
  TargetField field;           ///< both contacts
  std::vector<double> second;  ///< pressure of the second contact alone; zeros before it appears
};
inline constexpr int kAppearings = 8;  ///< pairs of contacts on the hand
inline constexpr int kAppearingFrame =
    50;  ///< first frame with the second contact, at full strength
/// Makes a frame of pair `which` of 0..kAppearings − 1: the contacts are a fingertip and the palm.
Appearing appearing(int which, int frame);

/// Returns the field rotated by 90°: cell (row, col) moves to (col, rows − 1 − row), point (x, y)
/// to (height of the raster − y, x).
TargetField rotated(const TargetField& field);

}  // namespace prostm::fields
