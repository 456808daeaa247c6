#pragma once
/// Parts of the state message (docs/reference/wire.md). Private to viewer.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "prostm/pipeline/live.hpp"

namespace prostm::viewer {

using Json = nlohmann::ordered_json;

Json millimetres(const Vec3& p);

/// All controls in display order. @param start initial settings of the run.
Json controls_json(const LiveSettings& settings, const LiveSettings& start);
/// @param holder page that holds the page's hand, or 0.
Json transport_json(const LiveState& state, PageHandState hand, std::uint32_t holder);
/// Rates set by the settings. @param advice current advice, None while they are held.
Json rates_json(const PipelineSettings& settings, const Advice& advice);
Json tracker_json(const std::optional<TrackerStatus>& tracker);
/// @param saved whether the pose was saved. @param file the file to which it is saved.
Json calibration_json(const std::optional<CalibrationGuide>& steps, bool saved,
                      const std::string& file, bool muted);

}  // namespace prostm::viewer
