#include "planner/contenders.hpp"

#include <fmt/core.h>

#include <cstring>
#include <stdexcept>
#include <utility>

namespace prostm::bench {
namespace {

/// Sets the one number of that name, in the unit that the settings keep it in.
class SetNumber : public SettingsVisitor {
 public:
  SetNumber(const char* name, double value) : name_(name), value_(value) {}
  bool found = false;

  void field(const char* name, double& value) override {
    if (std::strcmp(name, name_) != 0) return;
    value = value_;
    found = true;
  }
  void field(const char*, int&) override {}
  void field(const char*, bool&) override {}
  void field(const char*, std::string&) override {}

 private:
  const char* name_;
  double value_;
};

const std::vector<Variant>& variants() {
  static const std::vector<Variant> list{
      {"paper-valid", "paper-valid"},          {"fast", "fast"},
      {"fast, warm", "fast", 0.0, true},       {"best", "best"},
      {"best, warm", "best", 0.0, true},       {"best, 1 ms", "best", 1.0},
      {"best, 1 ms, warm", "best", 1.0, true}, {"best, 20 ms", "best", 20.0}};
  return list;
}

/// The planner forgets what it planned before, where it keeps anything.
template <class AnyPlanner>
bool forgets(AnyPlanner& planner) {
  if constexpr (requires { planner.reset(); }) {
    planner.reset();
    return true;
  } else {
    return false;
  }
}

}  // namespace

std::optional<PlanSettings> settings_of(const Variant& variant, std::string& why) {
  PlanSettings settings;
  settings.preset = variant.preset;
  try {
    preset_from_name(variant.preset);
  } catch (const std::invalid_argument& error) {
    why = error.what();
    return std::nullopt;
  }
  if (variant.budget_ms > 0.0) {
    SetNumber seconds("budget", 1e-3 * variant.budget_ms);
    SetNumber milliseconds("budget_ms", variant.budget_ms);
    settings.visit(seconds);
    settings.visit(milliseconds);
    if (!seconds.found && !milliseconds.found) {
      why = "the planner's settings have no time budget yet";
      return std::nullopt;
    }
  }
  return settings;
}

Contender::Contender(Variant variant, const PlanSettings& settings)
    : variant_(std::move(variant)), settings_(settings) {}

void Contender::begin(std::size_t cells) {
  cells_ = cells;
  planner_ = std::make_unique<Planner>(settings_, cells);
}

PlanStatus Contender::plan(const TargetField& target, Plan& plan, PlanStats& stats) {
  // the paper's presets keep nothing from frame to frame
  const bool keeps = variant_.preset != "paper" && variant_.preset != "paper-valid";
  if (!variant_.warm && keeps && !forgets(*planner_)) {
    planner_ = std::make_unique<Planner>(settings_, cells_);
  }
  return planner_->plan(target, plan, stats);
}

std::vector<Contender> available_contenders() {
  std::vector<Contender> list;
  for (const Variant& variant : variants()) {
    std::string why;
    if (const auto settings = settings_of(variant, why)) {
      list.emplace_back(variant, *settings);
    } else {
      fmt::print("left out: {} ({})\n", variant.name, why);
    }
  }
  return list;
}

std::vector<Contender> available_presets() {
  std::vector<Contender> list;
  for (const char* preset : {"paper-valid", "fast", "best"}) {
    const Variant variant{preset, preset};
    std::string why;
    if (const auto settings = settings_of(variant, why)) list.emplace_back(variant, *settings);
  }
  return list;
}

}  // namespace prostm::bench
