#pragma once
/// The summary of a run, on the terminal and as JSON.

#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "prostm/pipeline/realtime/verdict.hpp"

namespace prostm::app {

/// Returns the summary as prostm-run/1, see docs/guides/running.md.
nlohmann::ordered_json summary_json(const RunSummary& summary, const PipelineSettings& settings,
                                    const Verdict& verdict);

/// Prints the verdict, then the same numbers under headings. @param tracker of hands tracked live.
/// @param reading of a recording that is played, or null.
/// @param stopped_by cause of ending a run early, Interrupt::cause().
void print_summary(std::FILE* out, const RunSummary& summary, const PipelineSettings& settings,
                   const Verdict& verdict, const std::optional<TrackerStatus>& tracker,
                   const HandReading* reading, const std::string& stopped_by);

/// "tracker" of prostm-run/1: null for hands that are not tracked live.
nlohmann::ordered_json tracker_json(const std::optional<TrackerStatus>& tracker);

/// "hand_file" of prostm-run/1: null without a recording of hands.
nlohmann::ordered_json reading_json(const HandReading* reading);

}  // namespace prostm::app
