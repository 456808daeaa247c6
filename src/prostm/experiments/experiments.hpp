#pragma once
/// Published experiments with focal points on skin, computed with the skin model of
/// docs/design/skin.md. docs/experiments has a page for each.

#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "prostm/acoustics/skin/skin_model.hpp"

namespace prostm::experiments {

/// Skins to compute with; the middle one is nominal.
using Skins = std::span<const SkinSettings>;
/// Called repeatedly while an experiment is computed; an exception it throws ends the computation.
using Step = std::function<void()>;

/// Curves of a circle over its speeds on one skin.
struct Curve {
  std::vector<double> intensity;     ///< [m]
  std::vector<double> displacement;  ///< largest rms on the palm [m]
  std::vector<double> velocity;      ///< largest rms on the palm [m/s]
};
/// Curves of a circle on each skin, and on the nominal one with memoryless transducers.
struct CircleCurves {
  double circumference = 0.0;  ///< [m]
  std::vector<double> speeds;  ///< of the values of each curve [m/s]
  std::vector<Curve> skins;
  Curve memoryless;

  const Curve& nominal() const { return skins[skins.size() / 2]; }
};
inline constexpr std::array kCircumferences = {0.05, 0.1, 0.15, 0.2};  ///< [m]
std::vector<CircleCurves> circle_curves(std::span<const double> circumferences, Skins skins,
                                        const Step& step);
void draw_circles(const std::vector<CircleCurves>& all, const std::string& path);

/// Two foci, modulated at 200 Hz: the value midway between them over the higher peak, by gap; 1: a
/// single peak.
struct GapCurves {
  std::vector<double> gaps;      ///< [m]
  std::vector<double> acoustic;  ///< for the radiation pressure
  std::vector<SkinSettings> skins;
  std::vector<std::vector<double>> felt;  ///< for the percept on each skin
};
inline constexpr double kNoticed = 0.8;    ///< a dip of one Weber fraction, 0.2
inline constexpr double kGapRate = 200.0;  ///< frequency of the modulation [Hz]
GapCurves gap_curves(Skins skins, const Step& step);
/// Returns the gap from which on the dip stays at or below a level, interpolated [m]; 0 without
/// such a gap.
double gap_where(const std::vector<double>& gaps, const std::vector<double>& dips, double level);
void draw_gap(const GapCurves& curves, const std::string& path);

/// Extent of the waves about a focal point on a line: rms distance, weighted by ẇ², along it [m].
struct Reach {
  double ahead = 0.0, behind = 0.0;
};
/// Reaches at one speed [m/s]: on the nominal skin, in a window that is longer behind and in a
/// symmetric one, and the ratio of behind to ahead on each skin.
struct SpeedReach {
  double speed = 0.0;
  Reach nominal, even;
  std::vector<double> ratios;
};
std::vector<SpeedReach> line_reaches(std::span<const double> speeds, Skins skins, const Step& step);
void draw_lines(const std::string& path);

/// Measures of a square's map of skin velocity.
struct Look {
  double outline = 0.0;      ///< mean along the square [m/s]
  double inside = 0.0;       ///< largest in the inner half, over the largest of the map
  double middle = 0.0;       ///< centre over the mean along the square
  bool peak_inside = false;  ///< a local maximum lies in the inner half
  double half_width = 0.0;   ///< side of a square with the area above half of the largest [m]
};
/// Looks of the rms velocity and of the largest velocity at each speed, on one skin.
struct SquareLooks {
  std::vector<Look> rms, largest;
};
inline constexpr std::array kSquareSides = {0.01, 0.03};  ///< [m]
/// Returns the looks on each skin.
std::vector<SquareLooks> square_looks(double side, std::span<const double> speeds, Skins skins,
                                      const Step& step);
void draw_squares(const std::string& path);

/// Perceived intensity of a loop: the mean of √e along it, and √E of the palm [m].
struct LoopStrength {
  double along = 0.0, intensity = 0.0;
};
inline constexpr std::array kLoopLengths = {0.035, 0.0525, 0.070, 0.0875,
                                            0.105, 0.1225, 0.140};              ///< [m]
inline constexpr std::array kLoopSpeeds = {2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0};  ///< [m/s]
/// Strengths of circles on one skin, by length and speed.
using SkinLoops = std::vector<std::vector<LoopStrength>>;
inline constexpr double kUsualSpeed = 7.0;  ///< speed at which gains are compared [m/s]
struct LoopTable {
  std::vector<double> lengths, speeds;  ///< of the strengths [m], [m/s]
  std::vector<SkinSettings> settings;   ///< of each skin
  std::vector<SkinLoops> skins;

  const SkinLoops& nominal() const { return skins[skins.size() / 2]; }
  /// Index of kUsualSpeed in `speeds`. @pre it is there
  std::size_t usual_speed() const;
};
LoopTable loop_table(std::span<const double> lengths, std::span<const double> speeds, Skins skins,
                     const Step& step);
inline constexpr double kLongestGain = 1.4;  ///< γ of the longest loop at kUsualSpeed, (P9b)
/// Returns the gain of each length at kUsualSpeed that makes it as strong as the longest, whose
/// gain is 1. @param skin index of a skin.
std::vector<double> relative_gains(const LoopTable& table, std::size_t skin,
                                   double LoopStrength::*strength);
/// Returns the speed at which a loop is strongest [m/s]. @param skin, length indices in the table.
double strongest_speed(const LoopTable& table, std::size_t skin, std::size_t length,
                       double LoopStrength::*strength);
void draw_loops(const LoopTable& table, const std::string& path);

/// Returns the x of a curve's maximum over equally spaced x, by a parabola through the highest
/// value and its neighbours, or the end point if the highest value is there. @pre as many y as x,
/// at least 3.
double peak_place(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace prostm::experiments
