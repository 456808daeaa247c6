#include "prostm/study/protocol/level.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace prostm {
namespace {

constexpr double kMost = 1e6;  // largest size of a level, in any unit

template <class Settings, class V>
void list_levels(Settings& s, V& v) {
  v.field({.name = "setting", .help = "name of the setting to vary, e.g. \"plan.gain\""},
          s.setting);
  v.field({.name = "low", .least = -kMost, .most = kMost, .help = "lowest level"}, s.low);
  v.field({.name = "high", .least = -kMost, .most = kMost, .help = "highest level"}, s.high);
  v.field({.name = "scale", .help = "steps of a fixed size, or proportional to the level"},
          s.scale);
  v.field({.name = "start", .least = -kMost, .most = kMost, .help = "first level of a staircase"},
          s.start);
  v.field({.name = "step",
           .least = 0,
           .most = kMost,
           .help = "step of up-down and adjustment; a share of the level if scale is log"},
          s.step);
  v.field({.name = "reference", .least = -kMost, .most = kMost, .help = "level of the standard"},
          s.reference);
  v.field({.name = "against", .help = "the method used as standard"}, s.against);
  v.field({.name = "procedure", .help = "kind of staircase"}, s.procedure);
  v.field({.name = "share",
           .least = 0.05,
           .most = 0.95,
           .help = "share of answers for the level that up-down converges to"},
          s.share);
  v.field(
      {.name = "coarse", .least = 0, .most = 100, .help = "first reversals, with the double step"},
      s.coarse);
  v.field({.name = "reversals",
           .least = 2,
           .most = 1000,
           .help = "total reversals, after which up-down ends"},
          s.reversals);
  v.field({.name = "trials",
           .least = 1,
           .most = 1000,
           .help = "length of a bayes staircase; upper limit for up-down"},
          s.trials);
  v.field(
      {.name = "slope", .least = 0, .most = 1e9, .help = "of bayes; 0: 20 divided by the range"},
      s.slope);
  v.field({.name = "tracks",
           .least = 1,
           .most = 20,
           .help = "staircases for each scene with each method"},
          s.tracks);
  v.field(
      {.name = "interval", .unit = "s", .least = 0.2, .most = 60, .help = "length of a stimulus"},
      s.interval);
  v.field(
      {.name = "gap", .unit = "s", .least = 0.1, .most = 60, .help = "silence between intervals"},
      s.gap);
}

/// Sets the number with a given name.
class LevelWriter final : public SettingsWriter {
 public:
  LevelWriter(std::string_view name, double level) : name_(name), level_(level) {}

  void field(const Setting& s, double& value) override {
    if (s.name != name_) return;
    require_bounds(s, level_);
    value = set_ = level_;
    found_ = true;
  }
  void field(const Setting& s, int& value) override {
    if (s.name != name_) return;
    const int whole = static_cast<int>(std::lround(level_));
    require_bounds(s, whole);
    value = whole;
    set_ = whole;
    found_ = true;
  }
  void field(const Setting&, bool&) override {}
  void field(const Setting&, std::string&) override {}
  void choice(const Setting&, std::span<const std::string_view>, int&) override {}

  bool found() const { return found_; }
  double set() const { return set_; }

 private:
  std::string_view name_;
  double level_, set_ = 0.0;
  bool found_ = false;
};

}  // namespace

void LevelSettings::visit(SettingsReader& v) const {
  list_levels(*this, v);
}
void LevelSettings::visit(SettingsWriter& v) {
  list_levels(*this, v);
}

double LevelSettings::to_scale(double level) const {
  return scale == LevelScale::Log ? std::log(level) : level;
}
double LevelSettings::from_scale(double x) const {
  return scale == LevelScale::Log ? std::exp(x) : x;
}
double LevelSettings::step_on_scale() const {
  return scale == LevelScale::Log ? std::log1p(step) : step;
}

double set_level(PipelineSettings& settings, const std::string& setting, double level) {
  const std::size_t dot = setting.find('.');
  const std::string group = setting.substr(0, dot);
  // emit.foci is fixed: the array is set up for that number
  const bool changes = (group == "plan" || group == "am" || group == "emit") &&
                       dot != std::string::npos && setting != "emit.foci";
  if (changes) {
    LevelWriter writer(std::string_view(setting).substr(dot + 1), level);
    for (const SettingsGroup& g : settings_groups(settings))
      if (g.name == group) g.write(writer);
    if (writer.found()) return writer.set();
  }
  throw std::invalid_argument(
      fmt::format("setting = \"{:.60}\" is not a number of [plan], [am] or [emit] that can change "
                  "during a trial, such as \"plan.gain\"",
                  setting));
}

}  // namespace prostm
