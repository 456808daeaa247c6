#pragma once
/// Perceived intensity of a vibration of the skin: the Pacinian channel's sensitivity over
/// frequency and area, (S6) to (S8) of docs/design/skin.md. Intensities are in metres: the rms
/// displacement at 250 to 300 Hz that would feel equally strong. They are valid for vibrations
/// above threshold, 40 to 800 Hz.

#include "prostm/acoustics/skin/skin_motion.hpp"

namespace prostm {

/// Area for which the intensity of a uniform vibration equals its displacement [m²], A_0 of (S8).
inline constexpr double kPerceptArea = 2.9e-4;
/// Frequency from which intensity is summed over area [Hz].
inline constexpr double kAreaSumsFrom = 56.568542494923804;

/// Returns the displacement at 250 Hz that feels as strong as a displacement of 1 at `frequency` ≥
/// 0 [Hz], (S6).
double pacinian_sensitivity(double frequency);

/// Computes the map of perceived intensity √e [m], (S7). @param out rows·cols of the patch
void percept_map(const SkinMotion& motion, std::span<double> out);

/// Perceived intensity √E [m] of the whole patch, (S8).
double perceived_intensity(const SkinMotion& motion);

}  // namespace prostm
