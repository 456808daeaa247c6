#pragma once
/// Ultrasound arrays: positions and acoustic properties of the transducers.

#include <complex>
#include <span>
#include <string>
#include <vector>

#include "prostm/acoustics/array/directivity.hpp"
#include "prostm/core/geometry.hpp"
#include "prostm/core/medium.hpp"

namespace prostm {

inline constexpr int kMaxTransducers = 4096;
/// Transducers nearer to each other than this count as duplicates [m].
inline constexpr double kMinTransducerDistance = 1e-4;

/// Transducers of one type, driven at one frequency, at fixed positions: one array or several.
struct TransducerArray {
  std::string name;
  std::vector<Vec3> position;  ///< centres in D [m]
  std::vector<Vec3> normal;    ///< unit vectors in D along the transducers' axes
  double frequency = 40e3;     ///< [Hz]
  double radius = 4.5e-3;      ///< radius of the piston that gives the directivity [m]
  Directivity directivity = Directivity::Piston;
  double amplitude = 0.0;  ///< rms acoustic pressure × distance on axis at full drive [Pa·m]
  /// Lowest and highest amplitude in the literature [Pa·m]; both equal `amplitude` if there is only
  /// one source.
  double amplitude_low = 0.0, amplitude_high = 0.0;
  /// Amplitude that gives the sound level measured at a focus [Pa·m]; 0 if none was measured.
  double measured_amplitude = 0.0;
};

/// The Ultraleap STRATOS Explore's layout: 16×16 at 10.5 mm pitch, 40 kHz, x fastest, facing +z.
/// Amplitude 3.4 Pa·m rms, 2.5 to 8.0 (docs/design/acoustics.md); 1.09625 Pa·m gives the 155 dB
/// that were measured at a focus 0.2 m above the array.
TransducerArray usx_array();

/// One AUTD3: 249 transducers on a grid of 18×14 at 10.16 mm pitch without (x, y) = (1, 1), (2, 1)
/// and (16, 1), counted from 0; 40 kHz, x fastest, facing +z. The origin is the centre of the grid,
/// as always in D (in AUTD3's own frame it is transducer 0). Amplitude 4.386 Pa·m rms.
TransducerArray autd3_array();

/// A named array.
struct ArrayKind {
  const char* name;
  TransducerArray (*make)();
};
/// Returns all named arrays; the first is the default.
std::span<const ArrayKind> array_kinds();

/// Checks an array.
/// @throws std::invalid_argument for no transducer or more than kMaxTransducers; normals that are
/// not one per transducer; a position that is not finite or has a coordinate beyond 10 m; a normal
/// whose length is not 1 within 1e-9; two transducers within kMinTransducerDistance; a frequency
/// not in 20 to 100 kHz; a radius not in 0.1 to 50 mm; amplitudes not in 1e-6 to 1e3 Pa·m or not in
/// the order low ≤ amplitude ≤ high; a measured amplitude that is neither 0 nor in that range.
void validate(const TransducerArray& array);

/// Returns `array` with its positions and normals moved from its own frame A to D.
/// @throws std::invalid_argument if X_DA is not finite or not a rotation and a translation.
TransducerArray place(const TransducerArray& array, const Pose& X_DA);

/// Joins arrays into one, with the transducers in the order given and the names joined by " + ".
/// @throws std::invalid_argument if `arrays` is empty, or if they differ in frequency, directivity,
/// radius or amplitude.
TransducerArray join(std::span<const TransducerArray> arrays);

/// Wave number k = 2πf/c [rad/m].
double wave_number(const TransducerArray& array, const Medium& medium);

/// Wave number and absorption of an array's sound in air.
struct Wave {
  double number = 0.0;      ///< k [rad/m]
  double absorption = 0.0;  ///< α [Np/m], (M5)
};
/// Computes the wave in a medium. Evaluates several exponentials: reuse the result for repeated
/// calls of `propagate`.
Wave wave(const TransducerArray& array, const Medium& medium);

/// Complex rms acoustic pressure at p for unit drive of transducer i, (A1): A·D(θ)/r·e^{(ik − α)r}
/// [Pa]; θ is measured from the transducer's own normal.
/// @pre p is not on the transducer.
std::complex<double> propagate(const TransducerArray& array, const Wave& wave, std::size_t i,
                               const Vec3& p);
std::complex<double> propagate(const TransducerArray& array, const Medium& medium, std::size_t i,
                               const Vec3& p);

/// Acoustic pressure [Pa, rms] at p of a focus at p for which all transducers are driven fully, at
/// the nominal amplitude: the sum of their |pressure|, (A1).
double focus_pressure(const TransducerArray& array, const Medium& medium, const Vec3& p);

/// Computes the phases [rad] that focus the array on one point, (A3): −k r_i (naive focus).
/// @pre out.size() == position.size().
void focus_phases(const TransducerArray& array, const Medium& medium, const Vec3& focus,
                  std::span<double> out);

/// Radiation pressure [Pa] of an acoustic pressure (rms, [Pa]) on a surface that reflects all of it
/// and faces the sound, (A5): 2 p²/(ρc²).
double radiation_pressure(double acoustic_pressure_rms, const Medium& medium);

}  // namespace prostm
