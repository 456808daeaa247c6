#pragma once
/// The shape of amplitude modulation, AM baseline (B) in docs/design.md.

#include <cstdint>
#include <string>

namespace prostm {

/// Of the intensity a over a period, from 0 to 0 with its peak of 1 in the middle, (B4):
/// `raised-cosine`: a = (1 − cos 2πt)/2, the radiation pressure a² has the mean 3/8, 1/2 at the
/// frequency of the modulation and 1/8 at twice that. `sine-magnitude`: a = |sin πt|, the square
/// root of a raised cosine, so that a² is one itself: mean 1/2, 1/2 at the frequency, nothing at
/// twice that.
enum class Waveform : std::uint8_t { RaisedCosine, SineMagnitude };

/// @throws std::invalid_argument with a sentence for a name that is unknown.
Waveform waveform_from_name(const std::string& name);

/// a at `turns` of a period, 0..1; exactly 0 at 0.
double envelope(Waveform waveform, double turns);

}  // namespace prostm
