#pragma once
/// The speed limit of focal points.

namespace prostm {

/// Maximum speed of an audible focal point [m/s]. Settings above it are errors; an emitter plays
/// faster paths at it and counts them.
inline constexpr double kMaxFocusSpeed = 8.0;

/// Largest step between samples, as a share of that at the maximum speed: steps stay in bounds when
/// positions become floats.
inline constexpr double kStepMargin = 0.999;

}  // namespace prostm
