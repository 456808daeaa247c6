#pragma once
/// Messages about the rates of a run, one for each change.

#include <optional>
#include <string>

#include "prostm/pipeline/pipeline.hpp"
#include "prostm/pipeline/realtime/advice.hpp"

namespace prostm {

/// Reports during a real-time run when it does not hold its rates, with advice, and when it holds
/// them again.
class RateNews {
 public:
  /// Processes an update; updates may be missing. @param settings current settings of the run.
  /// @return a sentence, or nothing if there is no news.
  std::optional<std::string> look(const WorldFrame& contact, const PlanFrame& plan,
                                  const PipelineSettings& settings);

  /// Last advice; None while the rates are held.
  const Advice& advice() const { return advice_; }
  const Adviser& adviser() const { return adviser_; }

  static constexpr double kOver = 5.0;   ///< averaging time of rates [s]
  static constexpr double kHeld = 0.98;  ///< share of a rate that counts as held

 private:
  struct Span {
    double begin = 0.0;      // run time [s]
    int steps_per_plan = 0;  // value at the beginning
    std::int64_t steps = 0, plans = 0, updates = 0;
    double step_time = 0.0, plan_time = 0.0;  // sums over the updates [s]
  };

  std::optional<Span> span_;
  Adviser adviser_;
  Advice advice_;
  bool missed_ = false;
};

}  // namespace prostm
