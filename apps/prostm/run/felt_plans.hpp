#pragma once
/// How strongly the plans of a run are felt.

#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "prostm/acoustics/skin/sensation_level.hpp"
#include "prostm/core/random.hpp"
#include "prostm/pipeline/pipeline.hpp"

namespace prostm::app {

/// Sensation levels of plans, (S21) [dB].
struct FeltLevels {
  std::size_t plans = 0;  ///< number of plans with a percept
  double lowest = 0.0, median = 0.0, highest = 0.0;
};

/// Keeps a random sample of a run's plans, each with the same probability, and computes their
/// percepts after the run.
class FeltPlans {
 public:
  /// Keeps a plan or not. @pre it is Planned.
  void offer(const WorldFrame& contact, const PlanFrame& plan);

  /// Computes the percepts, which takes about a second. Nothing without plans or percepts. @param
  /// settings of the run.
  std::optional<FeltLevels> levels(const PipelineSettings& settings) const;

 private:
  static constexpr int kKept = 3;
  struct Kept {
    TargetFrame target;
    Plan plan;
    double full_scale_pressure = 0.0;
  };
  std::vector<Kept> kept_;
  int offered_ = 0;
  Random random_{1};
};

/// "sensation" of prostm-run/1: null without levels.
nlohmann::ordered_json felt_levels_json(const std::optional<FeltLevels>& levels,
                                        const SensationInterval& interval);

/// Prints the levels with their meaning; nothing without levels.
void print_felt_levels(std::FILE* out, const std::optional<FeltLevels>& levels,
                       const SensationInterval& interval);

}  // namespace prostm::app
