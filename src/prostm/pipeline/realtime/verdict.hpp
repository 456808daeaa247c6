#pragma once
/// Judges a run in a few sentences: whether its rates were held, and anything unusual.

#include <optional>
#include <string>
#include <vector>

#include "prostm/pipeline/runner.hpp"

namespace prostm {

struct Verdict {
  /// Whether smoke, plans and samples kept their rates; nothing without a clock.
  std::optional<bool> held;
  /// One to four sentences, the most important first: a held hand that did not get the stimulus,
  /// the rates and why they were not held, then anything unusual, with a remedy if one is known.
  std::vector<std::string> sentences;
};

/// @param settings initial settings of the run. @param tracker status, if hands were tracked live.
/// @param reading the reading of a recording of hands, or null.
Verdict verdict_of(const RunSummary& summary, const PipelineSettings& settings,
                   const std::optional<TrackerStatus>& tracker = {},
                   const HandReading* reading = nullptr);

/// Sentences about anything unusual in a recording of hands: its convention, and dropped frames.
std::vector<std::string> unusual_in(const HandReading& reading);

/// An actual and a nominal rate [Hz].
struct HeldRate {
  double done = 0.0, due = 0.0;
  /// Whether at most 1 % is missing.
  bool held() const;
};
/// "smoke 43.5 of 50 Hz, plans 21.8 of 25 Hz".
std::string rates_text(const RunSummary& summary, const PipelineSettings& settings);
HeldRate world_rate(const RunSummary& summary, const PipelineSettings& settings);
HeldRate plan_rate(const RunSummary& summary, const PipelineSettings& settings);

/// Whether the array lacked samples for at most 0.1 % of the time.
bool samples_held(const RunSummary& summary);

}  // namespace prostm
