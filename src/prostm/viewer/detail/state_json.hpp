#pragma once
/// The parts of the state message, docs/reference/wire.md. Private to viewer.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "prostm/pipeline/live.hpp"

namespace prostm::viewer {

using Json = nlohmann::ordered_json;

Json millimetres(const Vec3& p);

/// Every control, in the order in which to show them. @param start settings that the run began
/// with.
Json controls_json(const LiveSettings& settings, const LiveSettings& start);
/// @param holder the page that holds the page's hand, or 0.
Json transport_json(const LiveState& state, PageHandState hand, std::uint32_t holder);
/// Rates that the settings ask for. @param advice while they are not held.
Json rates_json(const PipelineSettings& settings, const Advice& advice);
Json tracker_json(const std::optional<TrackerStatus>& tracker);
/// @param file that the pose is saved to. @param saved whether it has been.
Json calibration_json(const std::optional<CalibrationGuide>& steps, bool saved,
                      const std::string& file, bool muted);

}  // namespace prostm::viewer
