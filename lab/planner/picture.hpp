#pragma once
/// A picture of the gallery.

#include <string>

#include "planner/contenders.hpp"

namespace prostm::bench {

/// Draws, for the middle frame of each of the nine fields, the target and the field rendered by
/// presets paper-valid and best, with their paths. @throws InputError if the file cannot be
/// written.
void draw_gallery_picture(const std::string& path);

}  // namespace prostm::bench
