#pragma once
/// The planners that are measured.

#include <memory>
#include <string>
#include <vector>

#include "prostm/plan/planner.hpp"

namespace prostm::bench {

/// One way to plan a sequence of targets: a preset with its settings, whose planner is either kept
/// from frame to frame or reset for each.
struct Variant {
  std::string name;        ///< as shown in tables
  std::string preset;      ///< a preset of PlanSettings
  double budget_ms = 0.0;  ///< time budget [ms]; 0 = the preset's own
  bool warm = false;       ///< plans every frame of a sequence with one planner
  int paths = PlanSettings{}.paths;
};

PlanSettings settings_of(const Variant& variant);

/// A variant's planner. If it is not warm, plan() ignores all earlier targets.
class Contender {
 public:
  explicit Contender(const Variant& variant);

  const Variant& variant() const { return variant_; }
  const std::string& name() const { return variant_.name; }
  const PlanSettings& settings() const { return settings_; }

  /// Starts a sequence of targets of at most `cells` cells: forgets all earlier plans.
  void begin(std::size_t cells);
  PlanStatus plan(const TargetField& target, Plan& plan, PlanStats& stats);

 private:
  Variant variant_;
  PlanSettings settings_;
  std::unique_ptr<Planner> planner_;
};

/// Returns all variants of the table.
std::vector<Contender> contenders();

/// Returns the presets alone, one variant each, for pictures and scaling.
std::vector<Contender> presets(int paths = PlanSettings{}.paths);

}  // namespace prostm::bench
