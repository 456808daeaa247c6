#pragma once
/// Ultrasound arrays: where the transducers are and how they sound.

#include <complex>
#include <span>
#include <string>
#include <vector>

#include "core/geometry.hpp"
#include "core/medium.hpp"

namespace prostm {

/// Identical transducers at fixed places, all facing +z of D.
struct TransducerArray {
  std::string name;
  std::vector<Vec3> position;  ///< centres in D [m]
  double frequency = 40e3;     ///< [Hz]
  double radius = 4.5e-3;      ///< of the piston that gives the directivity [m]
  double amplitude = 0.0;      ///< rms acoustic pressure × distance on axis at full drive [Pa·m]
};

/// The Ultraleap STRATOS Explore's layout: 16×16 at 10.5 mm pitch, 40 kHz, x fastest. Amplitude 3.4
/// Pa·m rms (docs/design.md, section 8).
TransducerArray usx_array();

/// Wave number k = 2πf/c [rad/m].
double wave_number(const TransducerArray& array, const Medium& medium);

/// Far-field directivity of a baffled piston, (A2): 2 J₁(ka sin θ)/(ka sin θ); 1 on axis. Even in
/// sin θ.
double piston_directivity(double ka, double sin_theta);

/// Complex rms acoustic pressure at p for unit drive of transducer i, (A1): A·D(θ)/r·e^{ikr} [Pa].
/// @pre p is not on the transducer.
std::complex<double> propagate(const TransducerArray& array, const Medium& medium, std::size_t i,
                               const Vec3& p);

/// Phases [rad] that focus the array on one point, (A3): −k r_i (naive focus). out.size() ==
/// position.size().
void focus_phases(const TransducerArray& array, const Medium& medium, const Vec3& focus,
                  std::span<double> out);

/// Radiation pressure [Pa] of an acoustic pressure (rms, [Pa]) on a surface that reflects all of it
/// and faces the sound, (A5): 2 p²/(ρc²).
double radiation_pressure(double acoustic_pressure_rms, const Medium& medium);

}  // namespace prostm
