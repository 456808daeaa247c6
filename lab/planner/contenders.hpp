#pragma once
/// The planners that a bench measures.

#include <memory>
#include <string>
#include <vector>

#include "prostm/plan/planner.hpp"

namespace prostm::bench {

/// One way to plan a sequence of targets: a preset with its settings, kept from frame to frame or
/// begun anew for each.
struct Variant {
  std::string name;        ///< in tables
  std::string preset;      ///< of PlanSettings
  double budget_ms = 0.0;  ///< time that it is given; 0 = the preset's own
  bool warm = false;       ///< plans every frame of a sequence with one planner
  int paths = PlanSettings{}.paths;
};

PlanSettings settings_of(const Variant& variant);

/// A variant's planner. plan() of one that is not warm knows nothing of the targets before.
class Contender {
 public:
  explicit Contender(const Variant& variant);

  const Variant& variant() const { return variant_; }
  const std::string& name() const { return variant_.name; }
  const PlanSettings& settings() const { return settings_; }

  /// Before a sequence of targets of at most `cells` cells: forgets what was planned.
  void begin(std::size_t cells);
  PlanStatus plan(const TargetField& target, Plan& plan, PlanStats& stats);

 private:
  Variant variant_;
  PlanSettings settings_;
  std::unique_ptr<Planner> planner_;
};

/// All variants of the table.
std::vector<Contender> contenders();

/// The presets alone, one variant each, for pictures and scaling.
std::vector<Contender> presets(int paths = PlanSettings{}.paths);

}  // namespace prostm::bench
