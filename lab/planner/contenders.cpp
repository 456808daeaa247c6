#include "planner/contenders.hpp"

namespace prostm::bench {
namespace {

const std::vector<Variant>& variants() {
  static const std::vector<Variant> list{
      {"paper-valid", "paper-valid"},          {"fast", "fast"},
      {"fast, warm", "fast", 0.0, true},       {"best", "best"},
      {"best, warm", "best", 0.0, true},       {"best, 1 ms", "best", 1.0},
      {"best, 1 ms, warm", "best", 1.0, true}, {"best, 20 ms", "best", 20.0}};
  return list;
}

}  // namespace

PlanSettings settings_of(const Variant& variant) {
  PlanSettings settings;
  settings.preset = from_name<Preset>(variant.preset, "preset");
  settings.paths = variant.paths;
  settings.budget = 1e-3 * variant.budget_ms;
  return settings;
}

Contender::Contender(const Variant& variant) : variant_(variant), settings_(settings_of(variant)) {}

void Contender::begin(std::size_t cells) {
  planner_ = std::make_unique<Planner>(settings_, cells);
}

PlanStatus Contender::plan(const TargetField& target, Plan& plan, PlanStats& stats) {
  if (!variant_.warm) planner_->reset();
  return planner_->plan(target, plan, stats);
}

std::vector<Contender> contenders() {
  std::vector<Contender> list;
  for (const Variant& variant : variants()) list.emplace_back(variant);
  return list;
}

std::vector<Contender> presets(int paths) {
  std::vector<Contender> list;
  for (const char* preset : {"paper-valid", "fast", "best"})
    list.emplace_back(Variant{preset, preset, 0.0, false, paths});
  return list;
}

}  // namespace prostm::bench
