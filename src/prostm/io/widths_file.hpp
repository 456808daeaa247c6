#pragma once
/// How wide the focus of an array is, in files: prostm-widths/1.

#include <span>
#include <string>

#include "prostm/acoustics/field/focus_width.hpp"

namespace prostm {

/// @param array its name.
std::string widths_to_json(const std::string& array, std::span<const FocusWidthEntry> widths);

}  // namespace prostm
