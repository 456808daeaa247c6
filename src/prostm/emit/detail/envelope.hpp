#pragma once
/// The shape of amplitude modulation, (B4) of docs/design/am.md.

#include "prostm/emit/emitter.hpp"

namespace prostm {

/// Returns a at `turns` of a period, 0..1; exactly 0 at 0.
double envelope(Waveform waveform, double turns);

}  // namespace prostm
