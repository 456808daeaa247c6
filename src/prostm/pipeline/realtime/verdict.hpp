#pragma once
/// A run judged in a few sentences: whether its rates were held, and what was unusual.

#include <optional>
#include <string>
#include <vector>

#include "prostm/pipeline/runner.hpp"

namespace prostm {

struct Verdict {
  /// Whether smoke, plans and samples kept their rates. Nothing without a clock: no rate is due.
  std::optional<bool> held;
  /// One to four, the most important first: a held hand that did not get the stimulus, the rates
  /// and why they were not held, then what was unusual, with a remedy where one is known.
  std::vector<std::string> sentences;
};

/// @param settings that the run began with.  @param tracker of hands that are tracked live.
/// @param reading of a recording of hands, or null.
Verdict verdict_of(const RunSummary& summary, const PipelineSettings& settings,
                   const std::optional<TrackerStatus>& tracker = {},
                   const HandReading* reading = nullptr);

/// Sentences about what is unusual in a recording of hands: its convention, and what was dropped.
std::vector<std::string> unusual_in(const HandReading& reading);

/// How often something was done, and how often it was due [Hz].
struct HeldRate {
  double done = 0.0, due = 0.0;
  /// Whether at most one in a hundred is missing.
  bool held() const;
};
/// "smoke 43.5 of 50 Hz, plans 21.8 of 25 Hz".
std::string rates_text(const RunSummary& summary, const PipelineSettings& settings);
HeldRate world_rate(const RunSummary& summary, const PipelineSettings& settings);
HeldRate plan_rate(const RunSummary& summary, const PipelineSettings& settings);

/// Whether the array lacked samples for at most a thousandth of the time.
bool samples_held(const RunSummary& summary);

}  // namespace prostm
