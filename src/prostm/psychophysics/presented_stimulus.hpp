#pragma once
/// Stimuli of published experiments: what an array, or a disk, presses on a flat patch of skin.
/// Equations (X1) to (X4) of docs/design/psychophysics.md.

#include <array>
#include <cstdint>
#include <string_view>
#include <variant>
#include <vector>

#include "prostm/core/geometry.hpp"
#include "prostm/core/text/json.hpp"
#include "prostm/core/text/names.hpp"

namespace prostm {

/// Closed outline of a path about the palm's centre.
enum class Outline : std::uint8_t { Line, Circle, Triangle, Square, Hexagon, Octagon };
template <>
inline constexpr std::array<std::string_view, 6> kNames<Outline> = {"line",   "circle",  "triangle",
                                                                    "square", "hexagon", "octagon"};
/// Corners of a polygon whose sides have the length `size`, the first one repeated at the end; 96
/// for a circle of that diameter, and the two ends of a line of that length [m].
std::vector<Vec2> corners(Outline outline, double size);

/// Amplitude-modulated focal points at rest. All have the same frequency, or each its own.
struct AmPoints {
  std::vector<Vec2> points;         ///< [m]; none: no stimulus
  std::vector<double> frequencies;  ///< [Hz]
};
/// Focal points of constant strength that follow each other along an outline at equal distances.
struct StmLoop {
  Outline outline = Outline::Circle;
  double size = 0.0;  ///< as for corners() [m]
  double rate = 0.0;  ///< laps per second [Hz]
  int foci = 1;
};
/// Uniform pressure on a disk: a square wave of 50 % duty, or a single pulse.
struct Disk {
  double area = 0.0;       ///< [m²]
  double force = 0.0;      ///< while the pressure is on [N]
  double frequency = 0.0;  ///< of the square wave [Hz]; 0: a pulse
  double pulse = 0.0;      ///< its duration [s]
};
/// A focal point that follows a way slowly. It is amplitude modulated, or swept over a short
/// section of the way.
struct SlowPath {
  std::vector<Vec2> way;   ///< corners [m]
  double lap = 0.0;        ///< time without pauses [s]
  double pause = 0.0;      ///< at each corner [s]; the last corner has none if the way is closed
  int moments = 24;        ///< number of positions besides the pauses
  double frequency = 0.0;  ///< of the modulation [Hz]; 0: swept
  double section = 0.0;    ///< length that is swept [m]
  double speed = 0.0;      ///< of the sweep [m/s]
};
/// One pass of a focal point along x, which also zigzags along y.
struct Sweep {
  double length = 0.0;  ///< [m]
  double speed = 0.0;   ///< along x [m/s]
  double zigzag = 0.0;  ///< from one side to the other [m]
  double rate = 0.0;    ///< of the zigzag [Hz]
};
using PresentedStimulus = std::variant<AmPoints, StmLoop, Disk, SlowPath, Sweep>;

/// @throws InputError for a kind, outline, member or number out of bounds.
PresentedStimulus stimulus_from_json(const JsonNode& node);

}  // namespace prostm
