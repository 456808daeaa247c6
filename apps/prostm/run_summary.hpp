#pragma once
/// What a run tells when it is over.

#include <cstdio>
#include <nlohmann/json.hpp>

#include "prostm/pipeline/runner.hpp"

namespace prostm::app {

/// prostm-run/1, see docs/running.md.
nlohmann::ordered_json summary_json(const RunSummary& summary, const PipelineSettings& settings);

/// The same in words.
void print_summary(std::FILE* out, const RunSummary& summary, const PipelineSettings& settings);
void print_tracker(std::FILE* out, const TrackerStatus& tracker);

/// "tracker" of prostm-run/1: null for hands that are not tracked live.
nlohmann::ordered_json tracker_json(const std::optional<TrackerStatus>& tracker);

}  // namespace prostm::app
