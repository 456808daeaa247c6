#pragma once
/// How well and how strongly the plans of a run render their targets.

#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "field/quality_words.hpp"
#include "prostm/acoustics/skin/sensation_level.hpp"
#include "prostm/core/random.hpp"
#include "prostm/core/worker_pool.hpp"
#include "prostm/pipeline/pipeline.hpp"
#include "prostm/score/score.hpp"

namespace prostm::app {

/// Quality of plans drawn at random from a run; what is felt is NaN if no percept was computed.
struct RunQuality {
  std::size_t plans = 0, felt_plans = 0;  ///< all, and those with a percept
  Metrics median, lowest, highest;        ///< of each metric
};

/// Keeps a random sample of a run's plans, each with the same probability, and scores them after
/// the run.
class PlanSample {
 public:
  /// Keeps a plan or not. @pre it is Planned.
  void offer(const WorldFrame& contact, const PlanFrame& plan);

  /// Scores the patch with the most pressure of each plan, as played, and with the width that it
  /// was planned for. Nothing without plans. @param settings of the run. @param with_percept
  /// whether the percepts are computed, too, which takes about a second.
  std::optional<RunQuality> quality(const PipelineSettings& settings, bool with_percept) const;

 private:
  static constexpr int kKept = 5;
  struct Kept {
    TargetFrame target;
    PlanFrame plan;
  };
  /// @param pool computes the percept; null: none is computed.
  static Metrics score(const Kept& kept, const PipelineSettings& settings, WorkerPool* pool);

  std::vector<Kept> kept_;
  int offered_ = 0;
  Random random_{1};
};

/// "quality" of prostm-run/1: null without plans.
nlohmann::ordered_json run_quality_json(const std::optional<RunQuality>& quality);
/// "sensation" of prostm-run/1: null without a percept.
nlohmann::ordered_json run_sensation_json(const std::optional<RunQuality>& quality,
                                          const SensationInterval& interval);

/// Prints the quality; nothing without plans. @param what the plans, in the plural. @param unfelt
/// why there is no percept, if so.
void print_run_quality(std::FILE* out, const std::string& what,
                       const std::optional<RunQuality>& quality, const SensationInterval& interval,
                       const std::string& unfelt = kPerceptLimits);

}  // namespace prostm::app
