#pragma once
/// Negative pressures that are a solver's rounding.

#include "prostm/target/target_field.hpp"

namespace prostm {

/// Negative pressures down to this share of a field's largest are rounding: a few times that of
/// float32.
inline constexpr double kPressureRounding = 1e-6;

/// Sets pressures from −kPressureRounding · largest to 0 to 0. Others stay, so that validate()
/// finds them.
void clear_rounding(TargetField& field);

}  // namespace prostm
