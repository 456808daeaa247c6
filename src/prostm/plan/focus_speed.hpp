#pragma once
/// The speed limit of focal points.

namespace prostm {

/// Maximum speed of a focal point that is not silent [m/s]. Settings above it are errors; an
/// emitter plays faster paths at this speed and counts them.
inline constexpr double kMaxFocusSpeed = 8.0;

/// Largest step between samples, as a share of the step at the maximum speed: a margin for rounding
/// positions to floats.
inline constexpr double kStepMargin = 0.999;

}  // namespace prostm
