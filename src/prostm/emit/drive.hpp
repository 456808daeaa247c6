#pragma once
/// From wanted to emitted intensities: power limit and slew limit.

#include <array>
#include <span>

#include "prostm/plan/plan.hpp"

namespace prostm {

/// One focal point's intensity.
struct Drive {
  double wanted = 0.0;     ///< requested by its path; 0 to fall silent
  double max_fall = 0.0;   ///< largest fall per sample
  double intensity = 0.0;  ///< emitted last, then emitted now
};

/// Largest change of intensity per sample for a fade over the full range in `fade_time` [s], never
/// above 1/40. @pre both > 0.
double largest_slew(double fade_time, double sample_rate);

/// Moves every intensity towards its wanted value, by at most max_rise up and max_fall down, with Σ
/// intensity² <= power limit, (E4). @return true when the power limit scaled the wanted intensities
/// down.
/// @pre 0 <= wanted <= 1 and the intensities of the last sample are within the limit.
bool limit_drives(std::span<Drive> drives, double max_rise, double power_limit) noexcept;

}  // namespace prostm
