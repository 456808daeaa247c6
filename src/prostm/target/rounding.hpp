#pragma once
/// Negative pressures due to a solver's rounding errors.

#include "prostm/target/target_field.hpp"

namespace prostm {

/// Share of a field's largest pressure up to which negative pressures count as rounding errors: a
/// few times the precision of float32.
inline constexpr double kPressureRounding = 1e-6;

/// Sets pressures in [−kPressureRounding · largest, 0] to 0. Lower ones are left unchanged, for
/// validate() to reject.
void clear_rounding(TargetField& field);

}  // namespace prostm
