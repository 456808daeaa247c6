#pragma once
/// The widths of an array's focus in files: prostm-widths/1.

#include <span>
#include <string>

#include "prostm/acoustics/field/focus_width.hpp"

namespace prostm {

/// @param array name of the array.
std::string widths_to_json(const std::string& array, std::span<const FocusWidthEntry> widths);

}  // namespace prostm
