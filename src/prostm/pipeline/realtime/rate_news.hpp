#pragma once
/// The news of a run's rates for those who watch it, each change once.

#include <optional>
#include <string>

#include "prostm/pipeline/pipeline.hpp"
#include "prostm/pipeline/realtime/advice.hpp"

namespace prostm {

/// Tells, while a run in real time goes on, that it does not hold its rates and what to turn down,
/// and that it holds them again.
class RateNews {
 public:
  /// Looks at an update, of which some may be left out. @param settings of the run now.
  /// @return a sentence, or nothing where there is nothing new.
  std::optional<std::string> look(const WorldFrame& contact, const PlanFrame& plan,
                                  const PipelineSettings& settings);

  /// Last advice; None while the rates are held.
  const Advice& advice() const { return advice_; }
  const Adviser& adviser() const { return adviser_; }

  static constexpr double kOver = 5.0;   ///< over which rates are taken [s]
  static constexpr double kHeld = 0.98;  ///< share of a rate that counts as kept

 private:
  struct Span {
    double begin = 0.0;      // run time [s]
    int steps_per_plan = 0;  // with which it began
    std::int64_t steps = 0, plans = 0, updates = 0;
    double step_time = 0.0, plan_time = 0.0;  // sums over the updates [s]
  };

  std::optional<Span> span_;
  Adviser adviser_;
  Advice advice_;
  bool missed_ = false;
};

}  // namespace prostm
