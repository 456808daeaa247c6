#pragma once
/// The shape of amplitude modulation, AM baseline (B) in docs/design.md.

#include "prostm/emit/emitter.hpp"

namespace prostm {

/// Returns a at `turns` of a period, 0..1; exactly 0 at 0.
double envelope(Waveform waveform, double turns);

}  // namespace prostm
