#pragma once
/// Grids of the smoke that keep the stimulus of a scene, measured on the held study hand.

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "prostm/pipeline/settings.hpp"

namespace prostm {

/// Smallest share of updates with the scene's stimulus for a grid to be recommended.
inline constexpr double kKeptShare = 0.8;

/// Effect of a grid on the stimulus of a scene.
enum class GridEffect : std::uint8_t {
  Keeps,   ///< the held study hand gets the stimulus, or the scene has none
  Loses,   ///< the hand gets the stimulus in less than kKeptShare of the updates
  Unknown  ///< not measured: other settings than the defaults, or another grid
};

/// Effect of `cells` along an edge, with all other settings unchanged.
GridEffect grid_effect(const PipelineSettings& settings, int cells);

/// Measured grids below `cells` that keep the stimulus of a scene, finest first; all of them for a
/// scene without a stimulus. @throws std::invalid_argument for an unknown scene.
std::vector<int> coarser_grids(std::string_view scene, int cells);

/// The coarsest measured grid above `cells` that keeps the scene's stimulus, or the finest measured
/// grid if none does.
int finer_grid(std::string_view scene, int cells);

/// Share of updates in which the held study hand gets the stimulus of a scene with default
/// settings, over a run of 30 s; nothing for a scene without a stimulus, or a grid that was not
/// measured.
std::optional<double> stimulus_share(std::string_view scene, int cells);

}  // namespace prostm
