#pragma once
/// Compares ways of rendering a target.

#include <array>
#include <string>
#include <vector>

#include "prostm/core/distribution.hpp"
#include "prostm/methods/rendering.hpp"

namespace prostm::methods {

/// The quantity that is equalised between ways before they are compared.
enum class Equal { Drive, Power, Percept };

/// Returns the factor for the square of a way's drives. Drive: the largest |q| becomes 1; Power: Σ
/// |q|² becomes the reference's; Percept: the largest percept becomes the reference's. 0 if the way
/// has no drives to scale.
double factor_for(Equal equal, const Rendering& rendering, const Rendering& reference);

/// Targets of one raster, 200 mm or so above the array.
using Targets = std::vector<TargetField>;
/// Returns `frames` frames of each generated sequence.
Targets generated_targets(int frames);
/// Returns `frames` frames of a recording's second half, when jets have settled on a still hand:
/// the first patch of each. @throws InputError if a frame has no pressure, or the raster changes.
Targets recorded_targets(const std::string& path, int frames);

/// Means over fields for one way of rendering.
struct Means {
  Distribution rmse, correlation, model_skill, model_overlap, model_spill;  ///< by Eq. (1)
  Distribution skill_0, skill_8, overlap, spill;                            ///< of the envelope
  Distribution felt_skill_8, felt_correlation, felt_overlap, felt_spill;    ///< of the percept
  Distribution lack, felt_lack;                                             ///< 1 − S_8.5 of each
  Distribution side_lobe, ghosts, ghost;
  struct Level {
    Distribution pressure, percept, intensity, lobe, ghost;  ///< [Pa], [µm]
  };
  std::array<Level, 3> level;  ///< by Equal; without values if a way has no drives

  void add(const Rendering& r, const Rendering& reference);
};
/// Renders a target in every way, by kWays. @return nothing if one of them has no percept
/// (Rendering::felt_at_all).
std::vector<Rendering> render_ways(Renderer& renderer, const TargetField& target);
/// Adds the renderings of a target to the means of each way. @pre one rendering for each of kWays
void add_ways(const std::vector<Rendering>& renderings, std::array<Means, kWays.size()>& means);

/// Draws the target, and for each way the envelope and the percept, for two generated fields.
void draw_ways(const std::string& path);

}  // namespace prostm::methods
