#pragma once
/// Generated targets, each next to its plans by several ways.

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "prostm/methods/rendering.hpp"

namespace prostm::methods {

inline constexpr std::array kGalleryWays = {Way::PaperValid, Way::Best, Way::Felt, Way::Am};

struct GalleryTarget {
  std::string name;
  TargetField target;
  std::array<Rendering, kGalleryWays.size()> renderings;  ///< by way
};

/// Renders the middle frame of the first `targets` generated sequences (of fields::kPatterns) for
/// the 16 × 16 array, on two threads.
/// @param progress called on either thread after each rendering, with the share that is done.
std::vector<GalleryTarget> render_gallery(std::size_t targets,
                                          const std::function<void(double)>& progress);

/// Draws the targets and the fields of the plans by Eq. (1), with the paths. Under each are its
/// RMSE and skill_8 by Eq. (1), and skill_8 and strength of the percept.
/// @throws InputError when the file cannot be written.
void draw_gallery_of_ways(const std::vector<GalleryTarget>& targets, const std::string& path);

}  // namespace prostm::methods
