#pragma once
/// A picture of the gallery.

#include <string>

#include "planner/contenders.hpp"

namespace prostm::bench {

/// Draws, for the middle frame of each of the nine fields, its target and what each preset renders,
/// paths included: paper-valid and, where it is there, best. @throws InputError when the file
/// cannot be written.
void draw_gallery_picture(const std::string& path);

}  // namespace prostm::bench
